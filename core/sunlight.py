"""Sunlight as exact polygons: where the beam lands, straight, through panes and off mirrors (virtual Suns).

The Sun's beam is collimated, so its shadow on a plane is a polygon. What each outline receives is its own polygon
less the prisms of all outlines nearer to the Sun; a lit piece of a mirror is the mouth of a further, reflected beam.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from . import clipping, polygons
from .outlines import Outlines
from .pieces import tightened
from .projection import reflect
from .sun_patches import SunPatch, Triangles, light_elements, shifts
from .tracing import DEEPEST_CHAIN

_ROUNDING = 1e-11

_ASIDE = np.array([6.1, 3.7, 7.1])

_RECEIVERS = 64
"""Outlines whose blockers are told at once."""


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
        return light_elements(self.patches, elements, outline_sheet)

    def shifts(self, elements: Triangles, outline_sheet) -> np.ndarray:
        """(e, 3) float: where within elements the patches' light falls; see `sun_patches.shifts`."""
        return shifts(self.patches, elements, outline_sheet)

    @property
    def blur(self) -> np.ndarray | float:
        """(e,) float, or 0: what elements get besides the patches; adds up to about nothing [lx]."""
        return 0.0

    def at(self, outlines: Outlines, points, normals) -> tuple[np.ndarray, np.ndarray]:
        """Sunlight at free points, straight and by mirrors, both (m,) float [lx]."""
        return light_points(outlines, self.beams, points, normals)


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
        vertices = clipping.clip(vertices[present], beam.ahead, start)
    cosine = outlines.normals[present] @ beam.travel
    side = np.sign(cosine)
    facing = np.abs(cosine) > 1e-12
    walls = prism(vertices, beam.travel, cosine)
    lit = np.flatnonzero(facing & ((cosine < 0) | outlines.back_counts[present]))
    regions = vertices[lit]
    if beam.mouth is not None:
        for normal, offset in zip(*_mouth_prism(beam.mouth, beam.travel), strict=True):
            regions = clipping.clip(regions, normal, offset)
        left = wide(regions, tolerance)
        lit, regions = lit[left], regions[left]
    upstream = -outlines.normals[present[lit]] * side[lit, None]
    start = -outlines.offsets[present[lit]] * side[lit]
    foremost = np.argsort(-np.abs(cosine) * polygons.areas(vertices), kind="stable")  # wide shadows leave least to cut
    found = []
    for first in range(0, len(lit), _RECEIVERS):
        some = slice(first, first + _RECEIVERS)
        around = prism(regions[some], beam.travel, cosine[lit[some]])
        low, high = _reach(vertices, upstream[some], start[some])
        meets = (high > tolerance) & facing & (present[lit[some], None] != present)
        meets &= _meet(walls, regions[some], tolerance).T & _meet(around, vertices, tolerance)
        for j, k in enumerate(lit[some].tolist()):
            region = regions[first + j][None]
            pieces = region, np.ones(1)
            for b in foremost[meets[j, foremost]].tolist():
                nearer, prism_of = vertices[b], (walls[0][b], walls[1][b])
                known = pieces[0] is region and low[j, b] >= 0
                if low[j, b] < 0:
                    (nearer,) = clipping.clip(nearer[None], upstream[first + j], start[first + j])
                    normals, offsets = prism(nearer[None], beam.travel, cosine[b : b + 1])
                    prism_of = normals[0], offsets[0]
                asked = None if known else nearer  # that the whole region is met is known
                pieces = _shadow(outlines, pieces, prism_of, asked, side[k], int(present[b]), beam.travel)
                if not len(pieces[0]):
                    break
            shown = wide(pieces[0], tolerance)
            shapes, corners = tightened(pieces[0][shown])
            lux = beam.normal_illuminance * abs(float(cosine[k]))
            for polygon, count, factor in zip(shapes, corners.tolist(), pieces[1][shown].tolist(), strict=True):
                lit_side = int(present[k]), bool(cosine[k] < 0)
                found.append(SunPatch(*lit_side, polygon[:count], lux * factor, beam.order))
    return found


def _reach(vertices, normals, offsets) -> tuple[np.ndarray, np.ndarray]:
    """(k, o) float twice: least and largest height of polygons ``(o, w, 3)`` over planes ``(k, 3)``, ``(k,)``."""
    height = (vertices @ normals.T - offsets).transpose(2, 0, 1)
    return height.min(axis=2), height.max(axis=2)


def _meet(walls, shapes, tolerance: float) -> np.ndarray:
    """(o, k) bool: polygons ``(k, v, 3)`` that reach within each of the ``walls`` of prisms, as of `prism`."""
    normals, offsets = walls
    reach = (normals.reshape(-1, 3) @ shapes.reshape(-1, 3).T).reshape(*offsets.shape, *shapes.shape[:2]).max(axis=3)
    return (reach > tolerance + offsets[:, :, None]).all(axis=1)


def _shadow(outlines: Outlines, pieces, walls, blocker: np.ndarray | None, side: float, outline: int, travel):
    """Pieces ``(m, v, 3)`` of an outline and their factors ``(m,)`` less a shadow; behind a pane it is kept, dimmed.

    ``walls`` bound the shadow. ``blocker``: its corners, to tell the pieces that it does not meet; None: it meets all.
    ``side`` is the sign of ``normal · travel`` of the pieces.
    """
    tolerance = outlines.tolerance
    batch, factors = pieces
    normals, offsets = walls
    heights = batch @ normals.T - offsets
    meets = np.ones(len(batch), bool)
    if blocker is not None:  # what lies beside the shadow stays whole
        meets = (heights.max(axis=1) > tolerance).all(axis=1)
        if meets.any():
            around, at = prism(batch[meets], travel, np.array([side]))
            meets[meets] = ((around @ blocker.T - at[:, :, None]).max(axis=2) > tolerance).all(axis=1)
        if not meets.any():
            return pieces
    left = [(batch[~meets], factors[~meets])]
    inside, factors = batch[meets], factors[meets]
    for edge in np.flatnonzero((heights[meets] < 0).any(axis=(0, 1))).tolist():
        normal, offset = normals[edge], offsets[edge]
        if (inside @ normal - offset).min() < 0:
            outside, inside = clipping.parted(inside, normal, offset)
            left.append((outside, factors))
    material = outlines.materials[outline]
    if material.is_transparent:
        through = float(material.transmittance_at(outlines.normals[outline] @ travel))
        left.append((inside, factors * through))
    parts = polygons.joined([part[0] for part in left])
    keep = wide(parts, tolerance)
    keep[: len(left[0][1])] = True
    return parts[keep], np.concatenate([part[1] for part in left])[keep]


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
