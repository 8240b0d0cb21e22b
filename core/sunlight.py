"""Sunlight as exact polygons: where the beam lands, straight, through panes and off mirrors (virtual Suns).

The Sun's beam is collimated, so its shadow on a plane is a polygon. What each outline receives is its own polygon
less the prisms of all outlines nearer to the Sun; a lit piece of a mirror is the mouth of a further, reflected beam.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import polygons
from .outlines import Outlines
from .projection import reflect
from .specular import DEEPEST_CHAIN


@dataclass(frozen=True, eq=False)
class Beam:
    """A collimated beam of sunlight.

    Attributes
    ----------
    travel : (3,) float, unit
        Direction in which light goes.
    normal_illuminance : float
        On a plane that faces it [lx].
    mouth : (v, 3) float or None
        Convex polygon that it comes out of; None for the Sun itself.
    ahead : (3,) float or None
        Normal of the mouth's plane on the side that the beam goes to.
    order : int
        Mirrors on the way.
    """

    travel: np.ndarray
    normal_illuminance: float
    mouth: np.ndarray | None = None
    ahead: np.ndarray | None = None
    order: int = 0


@dataclass(frozen=True, eq=False)
class SunPatch:
    """A convex piece of an outline that a beam lights evenly.

    Attributes
    ----------
    outline : int
    front : bool
    polygon : (v, 3) float
    illuminance : float
        Incident on the surface [lx].
    order : int
        Mirrors on the way.
    """

    outline: int
    front: bool
    polygon: np.ndarray
    illuminance: float
    order: int


@dataclass(frozen=True, eq=False)
class Sunlight:
    """All that the Sun lights.

    Attributes
    ----------
    beams : list
        Each a `Beam` (or a `DiscBeam` of :mod:`.penumbra`), the Sun's own first.
    patches : list of SunPatch
    truncated : float
        Flux of the chains that were cut off [lm].
    """

    beams: list
    patches: list[SunPatch]
    truncated: float

    def on_elements(self, elements: Triangles, outline_sheet) -> tuple[np.ndarray, np.ndarray]:
        """Means over elements of what comes straight and by mirrors.

        Parameters
        ----------
        elements : Triangles
        outline_sheet : (o,) int

        Returns
        -------
        direct, specular : (e,) float [lx]
        """
        direct, specular = (
            light_elements(self.patches, elements, outline_sheet, by_mirrors) for by_mirrors in (False, True)
        )
        return direct, specular

    @property
    def blur(self) -> np.ndarray | float:
        """(e,) float, or 0: what elements get besides the patches; adds up to about nothing [lx]."""
        return 0.0

    def at(self, outlines: Outlines, points, normals) -> tuple[np.ndarray, np.ndarray]:
        """Sunlight at free points, straight and by mirrors, both (m,) float [lx]."""
        return light_points(outlines, self.beams, points, normals)


_ROUNDING = 1e-11

_ASIDE = np.array([6.1, 3.7, 7.1])

NO_SUNLIGHT = Sunlight([], [], 0.0)


def trace_sun(
    outlines: Outlines, direction, normal_illuminance: float, cutoff: float, checkpoint: Callable[[], None]
) -> Sunlight:
    """Follow the Sun's beam through the scene.

    Parameters
    ----------
    outlines : Outlines
    direction : (3,) float
        Towards the Sun, unit.
    normal_illuminance : float
        [lx]
    cutoff : float
        Beams weaker than this share of the Sun are not followed.
    checkpoint : callable
        Called between beams; may raise to stop.

    Returns
    -------
    Sunlight
    """
    sun = Beam(-np.asarray(direction, float), float(normal_illuminance))
    waiting, beams, patches, truncated = [sun], [], [], 0.0
    while waiting:
        beam = waiting.pop(0)
        beams.append(beam)
        checkpoint()
        for patch in land(outlines, beam):
            patches.append(patch)
            material = outlines.materials[patch.outline]
            if not material.is_specular or not (
                patch.front or outlines.two_sided[patch.outline] or material.reflects_both_sides
            ):
                continue
            normal = outlines.normals[patch.outline]
            cosine = abs(float(beam.travel @ normal))
            share = float(material.specular_at(cosine))
            strength = patch.illuminance / cosine * share
            if strength < cutoff * normal_illuminance or patch.order >= DEEPEST_CHAIN:
                truncated += patch.illuminance * share * float(polygons.areas(patch.polygon))
                continue
            ahead = normal if patch.front else -normal
            waiting.append(Beam(reflect(beam.travel, normal), strength, patch.polygon, ahead, patch.order + 1))
    return Sunlight(beams, patches, truncated)


def land(outlines: Outlines, beam: Beam) -> list[SunPatch]:
    """Pieces of outlines that a beam reaches.

    Parameters
    ----------
    outlines : Outlines
    beam : Beam

    Returns
    -------
    list of SunPatch
    """
    tolerance = outlines.tolerance
    vertices = outlines.vertices
    present = np.arange(len(vertices))
    if beam.mouth is not None:
        start = float(beam.ahead @ beam.mouth[0])
        present = np.flatnonzero((vertices @ beam.ahead - start > tolerance).any(axis=1))
        vertices = polygons.clip(vertices[present], beam.ahead, start)
    cosine = outlines.normals[present] @ beam.travel
    walls, wall_offsets = prism(vertices, beam.travel, cosine)
    foremost = np.argsort(-np.abs(cosine) * polygons.areas(vertices), kind="stable")  # wide shadows leave least to cut
    found = []
    for k in np.flatnonzero(np.abs(cosine) > 1e-12):
        if cosine[k] > 0 and not outlines.back_counts[present[k]]:
            continue
        region = vertices[k][None]
        if beam.mouth is not None:
            around, at = _mouth_prism(beam.mouth, beam.travel)
            for normal, offset in zip(around, at, strict=True):
                region = polygons.clip(region, normal, offset)
            region = region[wide(region, tolerance)]
            if not len(region):
                continue
        pieces = region, np.ones(len(region))
        normal, plane = outlines.normals[present[k]], float(outlines.offsets[present[k]])
        upstream = -normal * np.sign(cosine[k])
        height = vertices @ upstream - plane * -np.sign(cosine[k])
        spread = np.einsum("owc,vc->owv", walls, region.reshape(-1, 3)) - wall_offsets[:, :, None]
        meets = (
            (height > tolerance).any(axis=1) & (np.abs(cosine) > 1e-12) & (spread.max(axis=2) > tolerance).all(axis=1)
        )
        meets[k] = False
        some = np.flatnonzero(meets)
        around, at = prism(region, beam.travel, cosine[k : k + 1])
        meets[some] = ((vertices[some] @ around[0].T - at[0]).max(axis=1) > tolerance).all(axis=1)
        for b in foremost[meets[foremost]]:
            nearer, around, at = vertices[b], walls[b], wall_offsets[b]
            if height[b].min() < 0:
                nearer = polygons.clip(nearer[None], upstream, -plane * np.sign(cosine[k]))
                (nearer,), (around,), (at,) = nearer, *prism(nearer, beam.travel, cosine[b : b + 1])
            pieces = _shadow(outlines, pieces, nearer, (around, at), int(present[b]), beam.travel)
            if not len(pieces[0]):
                break
        for polygon, factor in zip(*pieces, strict=True):
            if wide(polygon, tolerance):
                lux = beam.normal_illuminance * abs(float(cosine[k])) * float(factor)
                found.append(SunPatch(int(present[k]), bool(cosine[k] < 0), polygon, lux, beam.order))
    return found


def _shadow(outlines: Outlines, pieces, blocker, walls, outline: int, travel):
    """Pieces ``(m, v, 3)`` and their factors ``(m,)`` less a blocker's shadow; behind a pane it is kept, dimmed."""
    tolerance = outlines.tolerance
    batch, factors = pieces
    normals, offsets = walls
    # what lies beside the shadow stays whole
    meets = ((batch @ normals.T - offsets).max(axis=1) > tolerance).all(axis=1)
    if meets.any():
        around, at = prism(batch[meets], travel, np.sign(polygons.newell_normal(batch[meets]) @ travel))
        meets[meets] = ((around @ blocker.T - at[:, :, None]).max(axis=2) > tolerance).all(axis=1)
    if not meets.any():
        return pieces
    left = [(batch[~meets], factors[~meets])]
    inside, factors = batch[meets], factors[meets]
    for normal, offset in zip(normals, offsets, strict=True):
        if np.isinf(offset) or (inside @ normal - offset).min() >= 0:
            continue
        outside = polygons.clip(inside, -normal, -offset)
        keep = wide(outside, tolerance)
        left.append((outside[keep], factors[keep]))
        inside = polygons.clip(inside, normal, offset)
        lit = wide(inside, tolerance)
        inside, factors = inside[lit], factors[lit]
        if not len(inside):
            break
    material = outlines.materials[outline]
    if material.is_transparent:
        through = float(material.transmittance_at(outlines.normals[outline] @ travel))
        left.append((inside, factors * through))
    left = [part for part in left if len(part[1])] or left[:1]
    return polygons.joined([part[0] for part in left]), np.concatenate([part[1] for part in left])


def wide(shapes, tolerance: float) -> np.ndarray:
    """(...) bool: polygons ``(..., v, 3)`` wider than a length; what is narrower is rounding."""
    p = np.asarray(shapes)
    edge = np.concatenate([p[..., 1:, :], p[..., :1, :]], axis=-2) - p
    longest = np.sqrt((edge * edge).sum(axis=-1).max(axis=-1, initial=0.0))
    return polygons.areas(p) > tolerance * np.maximum(longest, tolerance)


def prism(polygon, travel, cosine) -> tuple[np.ndarray, np.ndarray]:
    """Half-spaces that bound the prisms of convex polygons along a direction.

    Parameters
    ----------
    polygon : (o, w, 3) float, padded
    travel : (3,) float
    cosine : (o,) float
        ``normal · travel`` of each polygon.

    Returns
    -------
    normals : (o, w, 3) float
        Zero for padding edges (which then bound nothing: offset -inf).
    offsets : (o, w) float
    """
    edge = polygons.following(polygon) - polygon
    normals = polygons.cross(travel, edge) * np.sign(cosine)[:, None, None]
    length = np.sqrt((normals * normals).sum(axis=2, keepdims=True))
    # corners that differ by rounding alone make no edge
    true = length > _ROUNDING * np.sqrt((edge * edge).sum(axis=2).max(axis=1, initial=0.0))[:, None, None]
    normals = np.where(true, normals / np.where(true, length, 1.0), 0.0)
    offsets = np.einsum("owc,owc->ow", normals, polygon)
    return normals, np.where(true[:, :, 0], offsets, -np.inf)


def _mouth_prism(mouth: np.ndarray, travel: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    facing = float(polygons.newell_normal(mouth) @ travel)
    normals, offsets = prism(mouth[None], travel, np.array([facing]))
    bounding = normals[0].any(axis=1)
    return normals[0][bounding], offsets[0][bounding]


@dataclass(frozen=True, eq=False)
class Triangles:
    """Elements, sheet by sheet.

    Attributes
    ----------
    corners : (e, 3, 3) float
    sheet : (e,) int, plus ``sheets`` for backs
    sheets : int
    """

    corners: np.ndarray
    sheet: np.ndarray
    sheets: int

    @cached_property
    def members(self) -> dict[int, np.ndarray]:
        """Elements of each side of a sheet that has some."""
        order = np.argsort(self.sheet, kind="stable")
        parts = np.split(order, np.flatnonzero(np.diff(self.sheet[order])) + 1)
        return {int(self.sheet[part[0]]): part for part in parts if len(part)}

    @cached_property
    def boxes(self) -> tuple[np.ndarray, np.ndarray]:
        """(3, e) float twice: lowest and highest coordinates of each."""
        return np.ascontiguousarray(self.corners.min(axis=1).T), np.ascontiguousarray(self.corners.max(axis=1).T)

    def around(self, some: np.ndarray, polygon) -> np.ndarray:
        """(k,) int: of some of them those that may lie within a polygon, by the boxes that bound them."""
        low, high = polygon.min(axis=0), polygon.max(axis=0)
        rounding = 1e-6 * (high - low).max()
        lowest, highest = self.boxes
        for axis in range(3):
            mine = highest[axis].take(some) >= low[axis] - rounding
            mine &= lowest[axis].take(some) <= high[axis] + rounding
            some = some[mine]
        return some


def light_elements(patches: list[SunPatch], elements: Triangles, outline_sheet, specular: bool) -> np.ndarray:
    """Mean illuminance on elements from sun patches: exactly the lit share of each.

    Parameters
    ----------
    patches : list of SunPatch
    elements : Triangles
    outline_sheet : (o,) int
    specular : bool
        Patches that came by mirrors, or those that did not.

    Returns
    -------
    (e,) float [lx]
    """
    out = np.zeros(len(elements.corners))
    for patch in patches:
        if (patch.order > 0) != specular:
            continue
        mine = elements.members.get(int(outline_sheet[patch.outline]) + (0 if patch.front else elements.sheets))
        if mine is not None:
            near = elements.around(mine, patch.polygon)
            out[near] += patch.illuminance * lit_share(elements.corners[near], patch.polygon)
    return out


def lit_share(triangles, polygon) -> np.ndarray:
    """(n,) float: share of each triangle's area inside a coplanar convex polygon ``(v, 3)``."""
    normal = polygons.newell_normal(polygon)
    edge = np.roll(polygon, -1, axis=0) - polygon
    inward = polygons.cross(normal, edge)
    length = np.linalg.norm(inward, axis=1)
    true = length > _ROUNDING * length.max()
    inward, start = inward[true] / length[true, None], polygon[true]
    offset = np.einsum("ec,ec->e", inward, start)
    distance = inward @ triangles.reshape(-1, 3).T - offset[:, None]
    distance = distance.reshape(len(inward), len(triangles), 3)
    low, high = distance.min(axis=2), distance.max(axis=2)
    inside = (low >= 0).all(axis=0)
    cut = np.flatnonzero(~inside & (high > 0).all(axis=0))
    share = inside.astype(float)
    part = triangles[cut]
    for n, h, across in zip(inward, offset, (low[:, cut] < 0).any(axis=1), strict=True):
        if across:
            part = polygons.clip(part, n, float(h))
    share[cut] = polygons.areas(part) / polygons.areas(triangles[cut])
    return share


def light_points(outlines: Outlines, beams: list[Beam], points, normals) -> tuple[np.ndarray, np.ndarray]:
    """Sunlight at free points.

    Parameters
    ----------
    outlines : Outlines
    beams : list of Beam
    points, normals : (m, 3) float

    Returns
    -------
    direct, specular : (m,) float [lx]
    """
    out = np.zeros((2, len(points)))
    for beam in beams:
        cosine = -(normals @ beam.travel)
        rows = np.flatnonzero(cosine > 1e-12)
        limit = np.full(len(rows), np.inf)
        if beam.mouth is not None:
            slope = float(beam.travel @ beam.ahead)
            limit = ((points[rows] - beam.mouth[0]) @ beam.ahead) / slope
            back = points[rows] - limit[:, None] * beam.travel
            around, at = _mouth_prism(beam.mouth, beam.travel)
            # beams that touch share their border: moved aside a little, a point on it is in one of them
            inside = ((back + outlines.tolerance * _ASIDE) @ around.T >= at).all(axis=1) & (limit > outlines.tolerance)
            rows, limit = rows[inside], limit[inside]
        if len(rows):
            clear = transmittance_along(outlines, points[rows], -beam.travel, limit)
            out[min(beam.order, 1), rows] += beam.normal_illuminance * cosine[rows] * clear
    return out[0], out[1]


def transmittance_along(outlines: Outlines, points, direction, limit) -> np.ndarray:
    """Share of light that comes along rays.

    Parameters
    ----------
    outlines : Outlines
    points : (m, 3) float
    direction : (3,) float, unit
        The same for all.
    limit : (m,) float
        Nothing farther than this blocks [m].

    Returns
    -------
    (m,) float
    """
    share = np.ones(len(points))
    cosine = outlines.normals @ direction
    walls, offsets = prism(outlines.vertices, direction, cosine)
    for o in np.flatnonzero(np.abs(cosine) > 1e-12):
        distance = (outlines.offsets[o] - points @ outlines.normals[o]) / cosine[o]
        height = np.abs(points @ outlines.normals[o] - outlines.offsets[o])
        met = (height > outlines.tolerance) & (distance > 0) & (distance < limit - outlines.tolerance)
        met &= (points @ walls[o].T >= offsets[o]).all(axis=1)
        if met.any():
            material = outlines.materials[o]
            share[met] *= float(material.transmittance_at(cosine[o])) if material.is_transparent else 0.0
    return share
