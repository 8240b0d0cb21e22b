"""Sunlight from the Sun's whole disc: true penumbrae, straight, through panes and by chains of mirrors.

What a face gets is a mean over the face and over the disc. Where the corners of a face say that nothing cuts the disc,
the face is wholly lit or wholly dark. For the rest one of the two means is exact and the other by quadrature: points of
faces narrower than the penumbra see the disc clipped, faces wider than it are clipped for points of the disc, and
faces that both kinds of penumbra cross are split.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from . import clipping, disc, polygons
from .materials import Material
from .outlines import Outlines
from .projection import HalfSpace
from .screens import Pieces, Screens
from .sun import Sun
from .sun_patches import Triangles
from .sunlight import Sunlight, trace_sun, wide
from .tracing import DEEPEST_CHAIN

_NARROW = 0.7
"""Faces up to this many penumbrae wide have the disc clipped at their points; wider ones are clipped themselves."""

_FEW_SCREENS = 3
"""Behind more screens light varies within a penumbra: faces have to be half as wide."""

_SPLITS = 3
_SAMPLES = 20_000
_TESTS = 500_000
_DARK = 1e-9
"""Of a beam: less on all elements of a mirror is rounding, and not followed."""


@dataclass(frozen=True, eq=False)
class DiscBeam:
    """The light of the Sun's disc after some mirrors.

    Attributes
    ----------
    screens : Screens
        Of all legs before the last, and the mirrors.
    share : float
        Product of the mirrors' reflectances.
    ahead : HalfSpace or None
        Before the last mirror, where the beam goes to.
    order : int
    """

    screens: Screens
    share: float
    ahead: HalfSpace | None
    order: int

    @property
    def axes(self) -> np.ndarray:
        """(3, 3) float: of the disc."""
        return self.screens.axes


@dataclass(frozen=True, eq=False)
class DiscSunlight(Sunlight):
    """Sunlight of a Sun with a disc.

    Attributes
    ----------
    part : (1, v, 3) float
        What of the disc's square is above the horizon.
    normal_illuminance : float [lx]
    direct, specular : (e,) float
        On the elements [lx].
    collimated : (e,) float
        On the elements, by the patches [lx].
    """

    part: np.ndarray
    normal_illuminance: float
    direct: np.ndarray
    specular: np.ndarray
    collimated: np.ndarray

    def on_elements(self, *_) -> tuple[np.ndarray, np.ndarray]:
        """See `Sunlight.on_elements`."""
        return self.direct, self.specular

    @property
    def blur(self) -> np.ndarray:
        """See `Sunlight.blur`."""
        return self.direct + self.specular - self.collimated

    def at(self, outlines: Outlines, points, normals) -> tuple[np.ndarray, np.ndarray]:
        """See `Sunlight.at`: here the disc is clipped by all that each point sees before it."""
        out = np.zeros((2, len(points)))
        for beam in self.beams:
            near = _ahead(outlines, beam)
            rows = max(1, _TESTS // max(1, near.forms.size + beam.screens.forms.size))
            for start in range(0, len(points), rows):
                some = slice(start, start + rows)
                found = beam.share * _at_points(beam, near, self.part, points[some], normals[some])
                out[min(beam.order, 1), some] += found
        direct, specular = self.normal_illuminance * out
        return direct, specular


@dataclass(frozen=True, eq=False)
class _Target:
    """A side of a sheet.

    Attributes
    ----------
    plane : HalfSpace
        Before it.
    outlines : (k,) int
    receivers : (n,) int
        Elements; none on the backs of panes, which mirror all the same.
    triangles : (n, 3, 3) float
        The elements, or those of the front.
    mirror : Material or None
    """

    plane: HalfSpace
    outlines: np.ndarray
    receivers: np.ndarray
    triangles: np.ndarray
    mirror: Material | None


def trace_disc(
    outlines: Outlines, sun: Sun, elements, element_sheet, outline_sheet, cutoff: float, checkpoint: Callable[[], None]
) -> DiscSunlight:
    """Light from the Sun's disc on all elements.

    Parameters
    ----------
    outlines : Outlines
    sun : Sun
        Its upper limb above the horizon.
    elements : (e, 3, 3) float
    element_sheet : (e,) int, plus the number of sheets for backs
    outline_sheet : (o,) int
    cutoff : float
        Beams weaker than this share of the Sun are not followed.
    checkpoint : callable
        Called between surfaces; may raise to stop.

    Returns
    -------
    DiscSunlight
        Its patches are those of a collimated Sun of the same vector illuminance: for light that they send on, the
        blur of their edges is a redistribution (`Sunlight.blur`).
    """
    axes, level = sun.disc_axes, sun.disc_horizon
    part, rule = clipping.clip(disc.SQUARE[None], np.array([-level, 0.0, 1.0])), disc.quadrature(level)
    targets = list(_targets(outlines, elements, element_sheet, outline_sheet))
    values, truncated = np.zeros((2, len(elements))), 0.0
    none = Screens(np.zeros((0, 3, 3)), np.zeros(0, bool), np.zeros(0), axes, outlines.tolerance)
    waiting, beams = [DiscBeam(none, 1.0, None, 0)], []
    while waiting:
        beam = waiting.pop(0)
        beams.append(beam)
        near = _ahead(outlines, beam)
        for target in targets:
            checkpoint()
            normal = target.plane.normal
            whole = float(disc.moments(_facing(part, normal, beam.axes))[0] @ (beam.axes @ normal))
            vertices = outlines.vertices[target.outlines].reshape(-1, 3)
            screens = _before(near, beam, target.plane, vertices) if whole > 0 else None
            if screens is None:
                continue
            mean = face_means(beam, screens, part, rule, normal, target.triangles)
            values[min(beam.order, 1), target.receivers] += beam.share * mean[: len(target.receivers)]
            if target.mirror is None or mean.max() <= _DARK * whole:
                continue
            share = beam.share * float(target.mirror.specular_at(normal @ beam.axes[0]))
            if share < cutoff or beam.order >= DEEPEST_CHAIN:
                truncated += share * float(mean @ polygons.areas(target.triangles))
                continue
            thrown = (_thrown(beam, screens, target.plane, outlines.vertices[o], share) for o in target.outlines)
            waiting += [following for following in thrown if following is not None]
    sharp = _collimated(outlines, sun, axes.T @ disc.moments(part)[0], cutoff, checkpoint)
    direct, specular = sun.normal_illuminance * values
    return DiscSunlight(
        beams,
        sharp.patches,
        truncated * sun.normal_illuminance,
        part,
        sun.normal_illuminance,
        direct,
        specular,
        np.add(*sharp.on_elements(Triangles(elements, element_sheet, int(outline_sheet.max()) + 1), outline_sheet)),
    )


def _collimated(outlines: Outlines, sun: Sun, vector, cutoff: float, checkpoint) -> Sunlight:
    """Sunlight of parallel rays with the disc's vector illuminance, relative to the normal illuminance."""
    length = float(np.linalg.norm(vector))
    return trace_sun(outlines, vector / length, length * sun.normal_illuminance, cutoff, checkpoint)


def _targets(outlines: Outlines, elements, element_sheet, outline_sheet) -> Iterator[_Target]:
    """Sides of sheets that receive or mirror."""
    sheets = int(outline_sheet.max()) + 1
    order = np.argsort(element_sheet, kind="stable")
    bounds = np.searchsorted(element_sheet[order], np.arange(2 * sheets + 1))
    members = [order[a:b] for a, b in itertools.pairwise(bounds)]
    for number in range(sheets):
        mine = np.flatnonzero(outline_sheet == number)
        if not len(mine):
            continue  # a double of another
        normal, offset = outlines.normals[mine[0]], float(outlines.offsets[mine[0]])
        material = outlines.materials[mine[0]]
        both = outlines.two_sided[mine[0]] or material.reflects_both_sides
        for front in (True, False):
            receivers = members[number if front else number + sheets]
            mirror = material if material.is_specular and (front or both) else None
            if len(receivers) or mirror is not None:
                plane = HalfSpace(normal, offset) if front else HalfSpace(-normal, -offset)
                triangles = elements[receivers if len(receivers) else members[number]]
                yield _Target(plane, mine, receivers, triangles, mirror)


def _facing(part, normal, axes) -> np.ndarray:
    """(1, v, 3) float: what of the disc is before a plane."""
    return clipping.clip(part, axes @ normal)


def _ahead(outlines: Outlines, beam: DiscBeam) -> Screens:
    """Outlines that the beam may meet, cut where it begins."""
    vertices, present = outlines.vertices, np.arange(len(outlines.vertices))
    if beam.ahead is not None:
        present = np.flatnonzero((vertices @ beam.ahead.normal - beam.ahead.offset > outlines.tolerance).any(axis=1))
        vertices = clipping.clip(vertices[present], beam.ahead.normal, beam.ahead.offset)
    cosine = outlines.normals[present] @ beam.axes[0]
    through = np.zeros(len(present))
    for k, o in enumerate(present):
        if outlines.materials[o].is_transparent:
            through[k] = float(outlines.materials[o].transmittance_at(cosine[k]))
    return Screens(vertices, np.zeros(len(present), bool), through, beam.axes, outlines.tolerance)


def _before(near: Screens, beam: DiscBeam, plane: HalfSpace, vertices) -> Screens | None:
    """Screens that matter to receivers in a plane, between the hull of vertices; None where no light can come."""
    if beam.ahead is not None and not (vertices @ beam.ahead.normal - beam.ahead.offset > near.tolerance).any():
        return None
    across = polygons.plane_basis(plane.normal)
    flat = vertices @ across.T
    low, high = flat.min(axis=0), flat.max(axis=0)
    frame = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
    hull = (frame @ across + plane.offset * plane.normal)[None]
    outside, inside, _ = (found[:, 0] for found in beam.screens.relation(hull))
    if (outside & beam.screens.window).any() or _shut(beam.screens, inside):
        return None
    screens = beam.screens.take(~(outside | (inside & beam.screens.window)))
    height = near.vertices @ plane.normal - plane.offset
    above = np.flatnonzero((height > near.tolerance).any(axis=1) & ~near.relation(hull)[0][:, 0])
    if not len(above):
        return screens
    cut = clipping.clip(near.vertices[above], plane.normal, plane.offset)
    kept = wide(cut, near.tolerance)
    between = replace(near.take(above[kept]), vertices=cut[kept])
    if _shut(between, between.relation(hull)[1][:, 0]):
        return None
    return screens.joined(between)


def _shut(screens: Screens, inside) -> bool:
    return bool((inside & ~screens.window & (screens.transmittance == 0)).any())


def _thrown(beam: DiscBeam, screens: Screens, plane: HalfSpace, outline, share: float) -> DiscBeam | None:
    """The beam that an outline of a mirror throws; None where it gets no light."""
    tolerance = screens.tolerance
    window = outline[None]
    if beam.ahead is not None:
        window = clipping.clip(window, beam.ahead.normal, beam.ahead.offset)
    if not wide(window, tolerance)[0]:
        return None
    outside, inside, _ = (found[:, 0] for found in screens.relation(window))
    if (outside & screens.window).any() or _shut(screens, inside):
        return None
    kept = screens.take(~(outside | (inside & screens.window))).reflected(plane.normal, plane.offset)
    mouth = Screens(window, np.ones(1, bool), np.ones(1), kept.axes, tolerance)
    return DiscBeam(kept.joined(mouth), share, plane, beam.order + 1)


def face_means(beam: DiscBeam, screens: Screens, part, rule, normal, triangles) -> np.ndarray:
    """Mean over triangles of one plane of what they get from the disc, per normal illuminance.

    Parameters
    ----------
    beam : DiscBeam
    screens : Screens
        Nothing of them beneath the plane.
    part : (1, v, 3) float
        What of the disc's square is above the horizon.
    rule : pair of (q, 3) and (q,) float
        Quadrature of that part.
    normal : (3,) float
    triangles : (n, 3, 3) float

    Returns
    -------
    (n,) float
        Times the beam's share and the normal illuminance it is the illuminance.
    """
    means = np.zeros(len(triangles))
    owner, weight = np.arange(len(triangles)), np.ones(len(triangles))
    disc_part, cosines = _facing(part, normal, beam.axes), beam.axes @ normal
    whole = float(disc.moments(disc_part)[0] @ cosines)
    for depth in range(_SPLITS + 1):
        factor, cut, narrowest, widest = _sort(beam, screens, triangles)
        crossed = (factor > 0) & (cut.any(axis=0) | np.isinf(widest))
        lit = (factor > 0) & ~crossed
        np.add.at(means, owner[lit], weight[lit] * factor[lit] * whole)
        many = cut.sum(axis=0) > _FEW_SCREENS
        by_disc = crossed & (widest <= np.where(many, 0.5 * _NARROW, _NARROW))
        by_face = crossed & ~by_disc & ((narrowest > _NARROW) | (depth == _SPLITS))
        for mine, method in ((by_disc, _clip_disc), (by_face, _clip_faces)):
            for rows in _chunks(np.flatnonzero(mine), len(rule[1])):
                found = method(beam, screens, disc_part, rule, cosines, triangles[rows], cut[:, rows])
                np.add.at(means, owner[rows], weight[rows] * factor[rows] * found)
        rest = np.flatnonzero(crossed & ~by_disc & ~by_face)
        if not len(rest):
            break
        triangles = quarters(triangles[rest])
        owner, weight = np.repeat(owner[rest], 4), np.repeat(weight[rest] / 4, 4)
    return means


def quarters(triangles) -> np.ndarray:
    """(4n, 3, 3) float: triangles ``(n, 3, 3)`` split at the middles of their sides."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    p, q, r = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
    parts = [(a, p, r), (p, b, q), (r, q, c), (p, q, r)]
    return np.stack([np.stack(t, axis=1) for t in parts], axis=1).reshape(-1, 3, 3)


def _chunks(rows, samples: int) -> list[np.ndarray]:
    step = max(1, _SAMPLES // samples)
    return [rows[start : start + step] for start in range(0, len(rows), step)]


def _sort(beam: DiscBeam, screens: Screens, triangles):
    """What wholly covers or misses each triangle, what cuts it, and its least and largest width in penumbrae.

    Returns
    -------
    factor : (n,) float
        Transmittance of all that covers it wholly; 0: dark.
    cut : (b, n) bool
    narrowest, widest : (n,) float
    """
    n = len(triangles)
    factor, cut = np.ones(n), np.zeros((len(screens), n), bool)
    narrowest, widest = np.full(n, np.inf), np.zeros(n)
    if beam.ahead is not None:
        height = triangles @ beam.ahead.normal - beam.ahead.offset
        factor[(height <= screens.tolerance).all(axis=1)] = 0.0
        widest[(height < -screens.tolerance).any(axis=1)] = np.inf
    for group in (np.flatnonzero(screens.window), np.flatnonzero(~screens.window)):
        some, alive = screens.take(group), np.flatnonzero(factor > 0)
        step = max(1, _TESTS // max(1, some.forms.size))
        for rows in (alive[start : start + step] for start in range(0, len(alive) if len(group) else 0, step)):
            outside, inside, ratio = some.relation(triangles[rows])
            crosses = ~(outside | inside)
            cut[np.ix_(group, rows)] = crosses
            beside, within = outside & some.window[:, None], inside & ~some.window[:, None]
            factor[rows] *= np.where(beside.any(axis=0), 0.0, some.dimming(within))
            edges = crosses[:, :, None] & ~np.isnan(ratio)
            narrowest[rows] = np.minimum(narrowest[rows], np.where(edges, ratio, np.inf).min(axis=(0, 2)))
            widest[rows] = np.maximum(widest[rows], np.where(edges, ratio, 0.0).max(axis=(0, 2)))
    return factor, cut, narrowest, widest


def _clip_disc(beam, screens, disc_part, rule, cosines, triangles, cut) -> np.ndarray:
    """(n,) float: means over triangles by points on them, each with the disc clipped exactly."""
    n, q = len(triangles), len(polygons.RADON_SHARES)
    points = np.einsum("qt,ntc->nqc", polygons.RADON_PLACES, triangles).reshape(-1, 3)
    seen = _seen_disc(screens, disc_part, points, np.repeat(cut, q, axis=1)) @ cosines
    return seen.reshape(n, q) @ polygons.RADON_SHARES


def _seen_disc(screens: Screens, disc_part, points, cut) -> np.ndarray:
    """(n, 3) float: moments of what points see of the disc past those screens that cut it, ``cut`` (b, n).

    ``disc_part`` is (1 or n, v, 3).
    """
    n = len(points)
    pieces = Pieces(np.broadcast_to(disc_part, (n, *disc_part.shape[1:])), np.arange(n), np.ones(n))
    for k in np.flatnonzero(cut.any(axis=1)):
        mine = cut[k][pieces.rows]
        if mine.any():
            lines = screens.lines_at(k, points)
            after = pieces.take(mine).behind(screens, k, lines, np.zeros(lines.shape[:2]))
            pieces = Pieces.joined([pieces.take(~mine), after])
    seen = np.zeros((n, 3))
    np.add.at(seen, pieces.rows, pieces.factor[:, None] * disc.moments(pieces.shapes))
    return seen


def _clip_faces(beam, screens, disc_part, rule, cosines, triangles, cut) -> np.ndarray:
    """(n,) float: means over triangles by points on the disc, each with the triangles clipped exactly."""
    places, weights = rule
    cosine = places @ cosines
    up = cosine > 0
    places, weights = places[up], (weights * cosine)[up]
    n, q = len(triangles), len(places)
    size = polygons.areas(triangles)
    pieces = Pieces(np.repeat(triangles, q, axis=0), np.arange(n * q), np.tile(weights, n))
    if beam.ahead is not None:
        pieces = pieces.take(np.tile(places @ (beam.axes @ beam.ahead.normal) < 0, n))
        count = len(pieces.rows)
        normals = np.broadcast_to(beam.ahead.normal, (count, 3))
        pieces, _ = pieces.parted(normals, np.full(count, beam.ahead.offset))
    for k in np.flatnonzero(cut.any(axis=1)):
        mine = cut[k][pieces.rows // q]
        if mine.any():
            normals, offsets = screens.planes_for(k, places)
            after = pieces.take(mine).behind(screens, k, np.tile(normals, (n, 1, 1)), np.tile(offsets, (n, 1)))
            pieces = Pieces.joined([pieces.take(~mine), after])
    lit = np.bincount(pieces.rows // q, weights=pieces.factor * polygons.areas(pieces.shapes), minlength=n)
    return lit / size


def _at_points(beam: DiscBeam, near: Screens, part, points, normals) -> np.ndarray:
    """(m,) float: what points with normals of their own get from the disc, per normal illuminance."""
    lines = normals @ beam.axes.T
    out = np.zeros(len(points))
    rows = np.flatnonzero(lines[:, 0] + np.hypot(lines[:, 1], lines[:, 2]) > 0)
    if beam.ahead is not None:
        rows = rows[points[rows] @ beam.ahead.normal - beam.ahead.offset > near.tolerance]
    screens = beam.screens.joined(near)
    outside, inside, _ = screens.relation(points[rows, None])
    factor = screens.dimming(inside & ~screens.window[:, None])
    factor[(outside & screens.window[:, None]).any(axis=0)] = 0.0
    lit = factor > 0
    rows, factor, cut = rows[lit], factor[lit], ~(outside | inside)[:, lit]
    if len(rows):
        shapes = clipping.clip(np.broadcast_to(part, (len(rows), *part.shape[1:])), lines[rows])
        seen = _seen_disc(screens, shapes, points[rows], cut)
        out[rows] = factor * np.einsum("nk,nk->n", seen, lines[rows])
    return out
