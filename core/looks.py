"""Looks: what some thousand rays from surfaces' fronts and backs meet, and what is odd about it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import polygons
from .arrays import dots
from .flaws import ERROR, Finding, warning
from .gaps import ways
from .planes import Planes
from .rays import RayScene
from .scene import Surface

ENDLESS = "endless reflection"
"""Kind of error where diffuse light has no steady state."""

_NOTHING, _UNSURE = -1, -2
_RAYS, _FEWER_RAYS, _MANY_OUTLINES = 64, 24, 20_000
_MOST_COVERED, _TOUCHING = 500, 1e-6
_HUNG_UP = 0.02
_MOST_SHEETS, _SHEETS_OF_MANY, _OF_ONE_SURFACE, _MOST_RAYS = 1_000, 300, 400, 20_000
_WORTH_A_LOOK = 2e-4
_BLIND, _SEEN, _MOSTLY = 0.02, 0.1, 0.45
_OWN = 0.98
_CLOSED_AREA = 0.02
_CHAIN_RAYS, _CUTOFF, _DEEPEST = 400, 1e-3, 200
_DEEP = 30.0
_MOST_PANES, _STILL_SEEN, _OFTEN = 12, 0.01, 0.01


@dataclass(frozen=True, eq=False)
class Looks:
    """What a sample of sheets looks at. Of n sheets, side k is the front of sheet k, side n + k its back.

    Attributes
    ----------
    sheets : (s,) int
        The sheets looked from.
    front, back : (s, r) int
        Side that each ray from the front and from the back meets; -1 where none, -2 where two that face each other
        touch, and either may be meant.
    receives : (2 n,) bool
        Whether a side receives light: all fronts, and backs of two-sided sheets.
    """

    sheets: np.ndarray
    front: np.ndarray
    back: np.ndarray
    receives: np.ndarray

    def lit(self, met: np.ndarray) -> np.ndarray:
        """Whether sides met receive light."""
        return (met >= 0) & self.receives[met]


def findings(surfaces: list[Surface], planes: Planes, rays: RayScene, touching: np.ndarray) -> list[Finding]:
    """Normals that look the wrong way, one-sided walls seen from behind, closed spaces, deep chains of mirrors.

    Parameters
    ----------
    surfaces : list of Surface
    planes : Planes
    rays : RayScene
        Of the planes' outlines.
    touching : (p, 2) int
        Sheets that lie on one another and look to opposite sides.
    """
    area = np.bincount(planes.outline_sheet, polygons.areas(planes.outlines), len(planes.sheet_normal))
    two_sided = np.array([surface.two_sided for surface in surfaces])[planes.sheet_surface]
    clear = np.array([surface.material.is_transparent for surface in surfaces])[planes.sheet_surface]
    many = len(planes.outlines) > _MANY_OUTLINES
    sheets = _largest(planes, area, _SHEETS_OF_MANY if many else _MOST_SHEETS)
    count = _FEWER_RAYS if many else max(_FEWER_RAYS, min(_RAYS, _MOST_RAYS // max(len(sheets), 1)))
    points = _places(planes, sheets, count).reshape(-1, 3)
    towards = np.stack([_directions(planes.sheet_normal[k], 0.37 * k, count) for k in sheets.tolist()])
    away = (
        towards
        - 2
        * np.einsum("src,sc->sr", towards, planes.sheet_normal[sheets])[..., None]
        * (planes.sheet_normal[sheets][:, None])
    )
    extent = np.sqrt(area[sheets])
    seen = Looks(
        sheets,
        _met(planes, rays, points, towards, extent, touching),
        _met(planes, rays, points, away, extent, touching),
        np.concatenate([np.ones(len(area), bool), two_sided]),
    )
    spared = two_sided | clear
    spared[touching.reshape(-1)] = True
    return [
        *_wrong_sides(surfaces, planes, seen, spared),
        *_closed(surfaces, planes, seen, area, clear),
        *_chains(surfaces, planes, rays, points, towards.reshape(-1, 3)),
        *_panes(surfaces, planes, rays, points, towards.reshape(-1, 3)),
    ]


def _met(planes: Planes, rays: RayScene, points, towards: np.ndarray, extent, touching: np.ndarray) -> np.ndarray:
    """(s, r) int: sides that rays from points ``(s r, 3)`` on sheets of an extent ``(s,)`` [m] meet, see `Looks`."""
    directions = towards.reshape(-1, 3)
    outline, distance = rays.nearest(points, directions)
    sheet = planes.outline_sheet[outline]
    behind = dots(directions, planes.sheet_normal[sheet]) > 0
    met = np.where(outline >= 0, sheet + behind * len(planes.sheet_normal), _NOTHING)
    met[(outline >= 0) & (distance < np.repeat(_HUNG_UP * extent, towards.shape[1]))] = _UNSURE
    if len(touching) > _MOST_COVERED:
        met[(met >= 0) & np.isin(sheet, touching)] = _UNSURE
        return met.reshape(towards.shape[:2])
    for here, there in (*touching.tolist(), *touching[:, ::-1].tolist()):
        mine = np.flatnonzero((met >= 0) & (sheet == here))
        place = points[mine] + distance[mine, None] * directions[mine]
        on = np.zeros(len(mine), bool)
        for other in np.flatnonzero(planes.outline_sheet == there):
            way = ways(place, planes.outlines[other][None], planes.sheet_normal[there][None])[0]
            on |= np.linalg.norm(way, axis=1) < _TOUCHING * planes.size
        met[mine[on]] = _UNSURE
    return met.reshape(towards.shape[:2])


def _largest(planes: Planes, area: np.ndarray, most: int) -> np.ndarray:
    """Some sheets of each surface, the largest, without those of next to no area."""
    order = np.lexsort((-area, planes.sheet_surface))
    surface = planes.sheet_surface[order]
    rank = np.arange(len(order)) - np.searchsorted(surface, surface)
    kept = order[(rank < _OF_ONE_SURFACE) & ((area[order] > _WORTH_A_LOOK * area.sum()) | (rank == 0))]
    return np.sort(kept[np.argsort(-area[kept], kind="stable")[:most]])


def _places(planes: Planes, sheets: np.ndarray, count: int) -> np.ndarray:
    """(s, r, 3) float: places spread over each sheet's area."""
    first = np.searchsorted(np.sort(planes.outline_sheet), sheets)
    by_sheet = np.argsort(planes.outline_sheet, kind="stable")
    counts = np.bincount(planes.outline_sheet, minlength=len(planes.sheet_normal))[sheets]
    share = (np.arange(count) + 0.5) / count
    spread = (0.5 + np.arange(count)[:, None] * [0.7548776662466927, 0.5698402909980532]) % 1.0
    u, v = 0.01 + 0.97 * np.where(spread.sum(axis=1, keepdims=True) > 1, 1 - spread, spread).T  # never on an edge
    out = np.empty((len(sheets), count, 3))
    for row, (start, outlines) in enumerate(zip(first.tolist(), counts.tolist(), strict=True)):
        loops = planes.outlines[by_sheet[start : start + outlines]]
        fans = np.stack([np.repeat(loops[:, :1], loops.shape[1] - 2, axis=1), loops[:, 1:-1], loops[:, 2:]], axis=2)
        triangles = fans.reshape(-1, 3, 3)
        sums = np.cumsum(polygons.areas(triangles))
        a, b, c = triangles[np.searchsorted(sums, share * sums[-1])].transpose(1, 0, 2)
        out[row] = a + u[:, None] * (b - a) + v[:, None] * (c - a)
    return out


def _directions(normal: np.ndarray, turn: float, count: int) -> np.ndarray:
    """(r, 3) float: directions about a normal, each standing for the same share of what a plane receives."""
    number = np.arange(count)[:, None]
    share, angle = ((0.5 + turn + number * [0.8191725133961645, 0.6710436067037893]) % 1.0).T
    first, second = polygons.plane_basis(normal)
    level = np.cos(2 * np.pi * angle)[:, None] * first + np.sin(2 * np.pi * angle)[:, None] * second
    return np.sqrt(share)[:, None] * level + np.sqrt(1 - share)[:, None] * normal


def _named(surfaces: list[Surface], planes: Planes, sheets: np.ndarray, limit: int = 3) -> str:
    number, count = np.unique(planes.sheet_surface[sheets], return_counts=True)
    names = [f"'{surfaces[k].name}'" for k in number[np.argsort(-count, kind="stable")][:limit]]
    return ", ".join(names) + (" …" if len(number) > limit else "")


def _concerned(planes: Planes, surface: int, sheets: np.ndarray) -> dict[str, np.ndarray]:
    mine = np.isin(planes.given_sheet, sheets)
    return {planes.surfaces[surface]: np.unique(planes.given_source[mine])}


def _wrong_sides(surfaces: list[Surface], planes: Planes, seen: Looks, spared: np.ndarray) -> list[Finding]:
    """One-sided sheets whose backs look at other surfaces' fronts."""
    surface, fronts = planes.sheet_surface[seen.sheets], len(planes.sheet_normal)
    sees = (seen.front != _NOTHING).mean(axis=1)
    own = (seen.front >= 0) & (planes.sheet_surface[seen.front % fronts] == surface[:, None])
    watchers = seen.lit(seen.back)
    from_behind = watchers.mean(axis=1)
    may = ~spared[seen.sheets]
    inverted = may & (from_behind >= _SEEN) & (sees <= _BLIND)
    lights = np.array(
        [s.material.diffuse_reflectance > 0 or s.material.is_specular or s.material.exitance > 0 for s in surfaces]
    )[surface]
    behind = may & ~inverted & (from_behind >= _MOSTLY) & lights
    found = []
    for k in np.unique(surface[inverted]).tolist():
        mine = inverted & (surface == k)
        watched = seen.back[mine][watchers[mine]] % fronts
        found.append(
            warning(
                "inverted normals",
                _concerned(planes, k, seen.sheets[mine]),
                f"Surface '{surfaces[k].name}' has its back to {_named(surfaces, planes, watched)} and its front sees "
                f"nothing{_looked_at(planes, seen, k)}",
                "turn its normals (reverse the order of the vertices), or make it two-sided",
            )
        )
    for k in np.unique(surface[behind]).tolist():
        mine = behind & (surface == k)
        watched = seen.back[mine][watchers[mine]] % fronts
        inside = own[mine].mean() >= _OWN  # a solid whose fronts look into itself
        found.append(
            warning(
                "inverted normals" if inside else "seen from behind",
                _concerned(planes, k, seen.sheets[mine]),
                f"Surface '{surfaces[k].name}' is seen from behind by {_named(surfaces, planes, watched)}, where it is "
                f"black: it has one side only{_looked_at(planes, seen, k)}",
                "turn its normals, make it two-sided, or give it a second surface behind",
            )
        )
    return found


def _looked_at(planes: Planes, seen: Looks, surface: int) -> str:
    """What to add where not all of a surface was looked from."""
    some = np.count_nonzero(planes.sheet_surface[seen.sheets] == surface)
    every = np.count_nonzero(planes.sheet_surface == surface)
    return "" if some == every else f" (of its {every} planes the {some} largest were looked at, others may be alike)"


def _closed(surfaces, planes: Planes, seen: Looks, area, clear) -> list[Finding]:
    """Spaces that no light comes into, and such that no light is lost in."""
    bright = np.array([s.material.exitance > 0 for s in surfaces])[planes.sheet_surface]
    mirror = np.array([s.material.specular_reflectance > 0 for s in surfaces])[planes.sheet_surface]
    kept = np.array([s.material.diffuse_reflectance + s.material.specular_reflectance for s in surfaces])
    fronts = len(area)
    looked, opened = np.zeros(2 * fronts, bool), np.tile(clear | bright, 2)
    lossy = np.tile((kept < 1 - 1e-9)[planes.sheet_surface], 2)
    for first, met in ((0, seen.front), (fronts, seen.back)):
        sides = seen.sheets + first
        looked[sides[seen.receives[sides]]] = True
        opened[sides] |= (met == _NOTHING).any(axis=1)
        lossy[sides] |= ~(seen.lit(met) | (met == _UNSURE)).all(axis=1)
    group = _groups(seen, fronts)
    found = []
    for k in np.unique(group[looked]).tolist():
        sides = np.flatnonzero((group == k) & looked)
        members = np.unique(sides % fronts)
        names, every = _named(surfaces, planes, members), _all_faces(planes, members)
        if len(members) < 2:
            continue
        if not lossy[sides].any():
            kind = ENDLESS
            said = f"Between {names} light is reflected without end: they enclose a space and absorb nothing"
            if mirror[members].any():
                kind = "endless mirrors"
                said = f"Between {names} light is mirrored without end: they enclose a space and absorb nothing"
            found.append(warning(kind, every, said, "lower their reflectances below 1, or open the space", ERROR))
        elif not opened[group == k].any() and area[members].sum() > _CLOSED_AREA * area.sum():
            found.append(
                warning(
                    "no opening",
                    every,
                    f"No light comes to {names}: they enclose a space without an opening or a luminous surface",
                    "open a window, or give a surface an exitance",
                )
            )
    return found


def _all_faces(planes: Planes, sheets: np.ndarray) -> dict[str, np.ndarray]:
    concerned: dict[str, np.ndarray] = {}
    for k in np.unique(planes.sheet_surface[sheets]).tolist():
        concerned |= _concerned(planes, k, sheets[planes.sheet_surface[sheets] == k])
    return concerned


def _groups(seen: Looks, fronts: int) -> np.ndarray:
    """(2 n,) int: sides that receive light and see each other, directly or by others, have the same number."""
    ones, twos = [], []
    for first, met in ((0, seen.front), (fronts, seen.back)):
        sides = seen.sheets + first
        row, ray = np.nonzero(seen.lit(met) & seen.receives[sides][:, None])
        ones.append(sides[row])
        twos.append(met[row, ray])
    one, two = np.concatenate(ones), np.concatenate(twos)
    number = np.arange(2 * fronts)
    while True:
        lowest = np.minimum(number[one], number[two])
        before = number.copy()
        np.minimum.at(number, one, lowest)
        np.minimum.at(number, two, lowest)
        number = number[number]
        if (number == before).all():
            return number


def _chains(surfaces, planes: Planes, rays: RayScene, points: np.ndarray, towards: np.ndarray) -> list[Finding]:
    """Mirrors between which looks go to and fro so often that it costs much."""
    mirror = np.array([s.material.specular_reflectance for s in surfaces])[planes.sheet_surface]
    if not (mirror > 0).any():
        return []
    kept = np.linspace(0, len(points) - 1, min(_CHAIN_RAYS, len(points))).astype(int)
    place, way, weight = points[kept], towards[kept], np.ones(len(kept))
    steps, deepest, met_mirrors = 0, 0, np.zeros(len(mirror), np.int64)
    while deepest < _DEEPEST:
        outline, distance = rays.nearest(place, way)
        sheet = planes.outline_sheet[outline]
        normal = planes.sheet_normal[sheet]
        slope = dots(way, normal)
        on = (outline >= 0) & (slope < 0) & (weight * mirror[sheet] >= _CUTOFF)
        if not on.any():
            break
        place = place[on] + distance[on, None] * way[on]
        way = (way - 2 * slope[:, None] * normal)[on]
        weight = (weight * mirror[sheet])[on]
        steps, deepest = steps + int(on.sum()), deepest + 1
        met_mirrors += np.bincount(sheet[on], minlength=len(mirror))
    mean = steps / len(kept)
    if mean < _DEEP:
        return []
    often = np.flatnonzero(met_mirrors > 0.05 * met_mirrors.sum())
    return [
        warning(
            "deep mirror chains",
            _all_faces(planes, often),
            f"Between {_named(surfaces, planes, often)} a look is mirrored {mean:.0f} times on average and up to "
            f"{deepest} times, so that looking takes some {mean + 1:.0f} times as long as without mirrors",
            "lower their reflectances, turn them a little, or raise specular_cutoff",
        )
    ]


def _panes(surfaces, planes: Planes, rays: RayScene, points: np.ndarray, towards: np.ndarray) -> list[Finding]:
    """Panes one behind the other, more than are looked through but by single rays."""
    clear = np.array([s.material.regular_transmittance for s in surfaces])[planes.sheet_surface]
    if np.count_nonzero(clear) <= _MOST_PANES:
        return []
    kept = np.linspace(0, len(points) - 1, min(_CHAIN_RAYS, len(points))).astype(int)
    place, way, weight = points[kept], towards[kept], np.ones(len(kept))
    for _ in range(_MOST_PANES + 1):
        outline, distance = rays.nearest(place, way)
        sheet = planes.outline_sheet[outline]
        on = (outline >= 0) & (weight * clear[sheet] >= _STILL_SEEN)
        place = place[on] + distance[on, None] * way[on]
        way, weight, sheet = way[on], (weight * clear[sheet])[on], sheet[on]
    if len(sheet) <= _OFTEN * len(kept):
        return []
    last = np.unique(sheet)
    return [
        warning(
            "many panes",
            _all_faces(planes, last),
            f"{_named(surfaces, planes, last)}: seen through more than {_MOST_PANES} panes, one behind the other. What "
            "is farther is found by one ray for each parcel, and several percent may be missing or too much",
            "put one pane of the product of their transmittances for some of them, or raise bands",
        )
    ]
