"""Bright few: luminous surfaces and sun patches as polygons, gathered exactly by Lambert's formula.

A small bright polygon is seen by few parcels or none. So its light is found without the globe: what a receiver sees
of the polygon is the polygon less the outlines in between, clipped exactly; in mirrors it is the same in the
mirrored scene, inside the mirror's outline.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from . import polygons
from .projection import HalfSpace, reflect_points
from .specular import DEEPEST_CHAIN, Outlines


@dataclass(frozen=True, eq=False)
class Source:
    """A convex polygon of even luminous exitance.

    Attributes
    ----------
    polygon : (v, 3) float
        Right-handed about the direction that it shines to.
    exitance : float [lm/m²]
    """

    polygon: np.ndarray
    exitance: float

    @property
    def plane(self) -> tuple[np.ndarray, float]:
        """Unit normal and offset of its plane."""
        normal = polygons.newell_normal(self.polygon)
        normal = normal / np.linalg.norm(normal)
        return normal, float(normal @ self.polygon.mean(axis=0))


@dataclass(frozen=True, eq=False)
class Screen:
    """An outline between the source and the receivers, in the receivers' mirrored space.

    Attributes
    ----------
    polygon : (w, 3) float
        What of the outline lies in between.
    outline : int
    aperture : bool
        A mirror that the light must come through, instead of something in the way.
    """

    polygon: np.ndarray
    outline: int
    aperture: bool

    def reflected(self, normal, offset: float) -> Screen:
        """Its image in a mirror."""
        return Screen(reflect_points(self.polygon, normal, offset), self.outline, self.aperture)


def gather_sources(
    outlines: Outlines,
    sources: list[Source],
    points,
    normal,
    cutoff: float,
    checkpoint: Callable[[], None] = lambda: None,
) -> np.ndarray:
    """Illuminance from sources at receivers of one plane, direct, through panes and in mirrors.

    Parameters
    ----------
    outlines : Outlines
    sources : list of Source
    points : (r, 3) float
        In one plane.
    normal : (3,) float, unit
    cutoff : float
        Smallest product of reflectances and transmittances that is followed.
    checkpoint : callable
        Called between sources; may raise to stop.

    Returns
    -------
    (r,) float [lx]
    """
    total = np.zeros(len(points))
    if not sources or not len(points):
        return total
    horizon = HalfSpace(np.asarray(normal, float), float(np.asarray(normal) @ points[0]))
    lit = _above(outlines.vertices, horizon, outlines.tolerance)
    mirrors = [o for o in np.flatnonzero(lit) if outlines.materials[o].is_specular]
    for source in sources:
        checkpoint()
        _gather(outlines, source, points, horizon, [], 1.0, None, mirrors, cutoff, 0, total)
    return total


def _gather(outlines, source, points, horizon, screens, throughput, beyond, mirrors, cutoff, depth, total) -> None:
    """Add what comes from the source past these screens; then look for it in one more mirror."""
    plane, at = source.plane
    visible = polygons.clip(source.polygon[None], horizon.normal, horizon.offset)
    if beyond is not None:
        visible = polygons.clip(visible, beyond.normal, beyond.offset)
    rows = np.flatnonzero(points @ plane - at > outlines.tolerance)
    if len(rows) and polygons.areas(visible)[0] > outlines.tolerance**2:
        limits = [HalfSpace(plane, at), horizon] + ([beyond] if beyond is not None else [])
        blockers = [Screen(polygon, o, False) for o, polygon in _between(outlines, points[rows], visible[0], limits)]
        total[rows] += source.exitance * _seen_factor(
            outlines, visible[0], points[rows], horizon.normal, [*screens, *blockers]
        )
    if depth >= DEEPEST_CHAIN:
        return
    for o in mirrors:
        _gather_mirrored(
            outlines, source, points, horizon, screens, throughput, beyond, mirrors, cutoff, depth, total, o
        )


def _gather_mirrored(
    outlines, source, points, horizon, screens, throughput, beyond, mirrors, cutoff, depth, total, o
) -> None:
    material, two_sided = outlines.materials[o], outlines.two_sided[o]
    product = throughput * float(
        np.max(
            material.specular_at(np.linspace(0.05, 1, 8))
            if material.refractive_index
            else material.specular_reflectance
        )
    )
    if product < cutoff:
        return
    normal, offset = outlines.normals[o], float(outlines.offsets[o])
    sides = (1.0, -1.0) if two_sided or material.reflects_both_sides else (1.0,)
    for side in sides:
        rows = np.flatnonzero(side * (points @ normal - offset) > outlines.tolerance)
        ahead = HalfSpace(side * normal, side * offset)
        if not len(rows) or not (source.polygon @ ahead.normal - ahead.offset > outlines.tolerance).any():
            continue
        aperture = polygons.clip(outlines.vertices[o][None], horizon.normal, horizon.offset)
        if beyond is not None:
            aperture = polygons.clip(aperture, beyond.normal, beyond.offset)
        if polygons.areas(aperture)[0] <= outlines.tolerance**2:
            continue
        if screens:
            mouths = [s for s in screens if s.aperture]
            rows = rows[_seen_factor(outlines, aperture[0], points[rows], horizon.normal, mouths, any_side=True) > 0]
            if not len(rows):
                continue
        limits = [ahead, horizon] + ([beyond] if beyond is not None else [])
        before = [Screen(p, b, False) for b, p in _between(outlines, points[rows], aperture[0], limits, skip=o)]
        passed = [s.reflected(normal, offset) for s in [*screens, *before]]
        through = Screen(aperture[0], int(o), True)
        part = np.zeros(len(rows))
        _gather(
            outlines,
            source,
            reflect_points(points[rows], normal, offset),
            horizon.reflected(normal, offset),
            [*passed, through],
            product,
            ahead,
            mirrors,
            cutoff,
            depth + 1,
            part,
        )
        total[rows] += part


def _above(vertices, half: HalfSpace, tolerance: float) -> np.ndarray:
    return (vertices @ half.normal - half.offset > tolerance).any(axis=1)


def _between(outlines: Outlines, points, target, half_spaces: list[HalfSpace], skip: int = -1):
    """Outlines, cut to the half-spaces, whose plane separates some receiver from some of the target."""
    tolerance = outlines.tolerance
    mask = np.ones(len(outlines.vertices), bool)
    for half in half_spaces:
        mask &= _above(outlines.vertices, half, tolerance)
    if skip >= 0:
        mask[skip] = False
    index = np.flatnonzero(mask)
    low, high = points.min(axis=0), points.max(axis=0)
    pick = np.indices((2, 2, 2)).reshape(3, -1).T.astype(bool)
    corners = np.where(pick, high, low) if len(points) > 8 else points
    normals, offsets = outlines.normals[index], outlines.offsets[index]
    near = corners @ normals.T - offsets
    far = target @ normals.T - offsets
    apart = ((near.max(axis=0) > tolerance) & (far.min(axis=0) < -tolerance)) | (
        (near.min(axis=0) < -tolerance) & (far.max(axis=0) > tolerance)
    )
    for o in index[apart]:
        part = outlines.vertices[o][None]
        for half in half_spaces:
            part = polygons.clip(part, half.normal, half.offset)
        if polygons.areas(part)[0] > tolerance**2:
            yield int(o), part[0]


def _seen_factor(
    outlines: Outlines, target, points, normal, screens: list[Screen], any_side: bool = False
) -> np.ndarray:
    """(r,) float: form factor to what is seen of a polygon, times what the screens let through or reflect."""
    row = np.arange(len(points))
    shape = target[None] - points[:, None]
    weight = np.ones(len(points))
    for screen in screens:
        relative = screen.polygon[None] - points[:, None]
        planes = polygons.cross(relative, np.roll(relative, -1, axis=1))
        facing = np.einsum("rc,rc->r", polygons.newell_normal(relative), relative[:, 0])
        planes *= np.sign(facing)[:, None, None]
        length = np.linalg.norm(planes, axis=2)
        size = np.linalg.norm(relative, axis=2).max(axis=1) ** 2
        edges = length > 1e-14 * size[:, None]
        planes = np.where(edges[:, :, None], planes / np.where(edges, length, 1.0)[:, :, None], 0.0)
        flat = facing == 0
        height = np.einsum("nvc,nwc->nvw", shape, planes[row])
        reach = np.abs(shape).max(axis=(1, 2))
        overlaps = ((height.max(axis=1) > 1e-12 * reach[:, None]) | ~edges[row]).all(axis=1) & ~flat[row]
        row, shape, weight = _pass_screen(outlines, screen, row, shape, weight, planes, edges, overlaps)
        if not len(row):
            return np.zeros(len(points))
    factor = polygons.lambert_form_factor(shape, normal)
    factor = np.abs(factor) if any_side else np.maximum(factor, 0.0)
    return np.bincount(row, weights=weight * factor, minlength=len(points))


def _pass_screen(outlines, screen, row, shape, weight, planes, edges, overlaps):
    kept = [] if screen.aperture else [(row[~overlaps], shape[~overlaps], weight[~overlaps])]
    row, shape, weight = row[overlaps], shape[overlaps], weight[overlaps]
    normal = outlines.normals[screen.outline]
    material = outlines.materials[screen.outline]
    for e in range(planes.shape[1]):
        if not len(row):
            break
        wall = planes[row, e]
        if not screen.aperture:
            outside = polygons.clip(shape, -wall)
            keep = edges[row, e] & _has_area(outside)
            kept.append((row[keep], outside[keep], weight[keep]))
        inside = polygons.clip(shape, wall)
        inside = inside if edges[:, e].all() else _choose(edges[row, e], inside, shape)
        keep = _has_area(inside)
        row, shape, weight = row[keep], inside[keep], weight[keep]
    if screen.aperture or material.is_transparent:
        centre = shape.mean(axis=1)
        cosine = np.abs(centre @ _plane_of(screen, normal)) / np.maximum(np.linalg.norm(centre, axis=1), 1e-300)
        share = material.specular_at(cosine) if screen.aperture else material.transmittance_at(cosine)
        kept.append((row, shape, weight * share))
    width = max([s.shape[1] for _, s, _ in kept if len(s)], default=1)
    padded = [
        np.concatenate([s, np.repeat(s[:, -1:], width - s.shape[1], axis=1)], axis=1) for _, s, _ in kept if len(s)
    ]
    if not padded:
        return row[:0], np.zeros((0, 1, 3)), weight[:0]
    return (
        np.concatenate([r for r, s, _ in kept if len(s)]),
        np.concatenate(padded),
        np.concatenate([w for _, s, w in kept if len(s)]),
    )


def _plane_of(screen: Screen, fallback) -> np.ndarray:
    normal = polygons.newell_normal(screen.polygon)
    length = np.linalg.norm(normal)
    return normal / length if length > 0 else fallback


def _choose(which, one, other):
    width = max(one.shape[1], other.shape[1])
    one = np.concatenate([one, np.repeat(one[:, -1:], width - one.shape[1], axis=1)], axis=1)
    other = np.concatenate([other, np.repeat(other[:, -1:], width - other.shape[1], axis=1)], axis=1)
    return np.where(which[:, None, None], one, other)


def _has_area(shapes) -> np.ndarray:
    """Whether clipped polygons, relative to their receivers, still span a solid angle."""
    if not len(shapes):
        return np.zeros(0, bool)
    twice = np.linalg.norm(polygons.newell_normal(shapes), axis=1)
    return twice > 1e-20 * np.maximum(np.abs(shapes).max(axis=(1, 2)), 1e-300) ** 2
