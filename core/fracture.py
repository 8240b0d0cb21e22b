"""Fracture: planes into faces (what is reported) and elements (what receives)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from . import polygons
from .errors import SceneError
from .grid import Grid
from .nearness import closeness
from .planes import Planes

DEFAULT_FACES = 10_000
"""Faces that a scene is cut into where the user gives no ``max_area``."""

MOST_FACES = 5_000_000
"""Faces that a scene is never cut into: a ``max_area`` that asks for more is taken for a slip."""

FEWEST_ELEMENTS = 4_000
"""Receivers that the diffuse surfaces have together, however coarse their faces are."""

ELEMENTS_PER_PLAIN_SURFACE = 100
"""Receivers inside a surface that neither emits nor reflects diffusely, and so is not cut itself."""

MOST_FINER, TIMES_FINER = 40_000, 4
"""Elements at most that a scene gets beyond those for its faces, where other surfaces are near; and how many times as
many as its runs have otherwise, or of these the share of one of the other outlines, whichever is more."""

_FEWEST_CELLS = 4
_MOST_SLENDER = 4.0
_MOST_TESTS = 2_000_000
"""Runs times outlines that are looked at for what is near."""


@dataclass(frozen=True, eq=False)
class Triangles:
    """Triangles with what they come from.

    Attributes
    ----------
    vertices : (n, 3, 3) float, relative to the scene's centre
    parent : (n,) int
        Index of the piece or face that each was cut from.
    grids : tuple of Grid
        Regular runs among them.
    """

    vertices: np.ndarray
    parent: np.ndarray
    grids: tuple[Grid, ...] = ()

    @property
    def areas(self) -> np.ndarray:
        """(n,) float [m²]."""
        return polygons.areas(self.vertices)


def cut_pieces(pieces, counts, max_areas) -> Triangles:
    """Cut convex pieces into triangles of limited area.

    Parallelograms become regular grids of near-square cells, two triangles each, as in the paper; other shapes are
    halved across their longest edge.

    Parameters
    ----------
    pieces : (m, v, 3) float, padded
    counts : (m,) int
    max_areas : (m,) float
        Largest area of a triangle [m²]; inf = only triangulated.

    Returns
    -------
    Triangles
    """
    counts = np.asarray(counts)
    limits = np.asarray(max_areas, float)
    order, triangles = [], []
    v = pieces
    closes = (counts == 4) & (pieces.shape[1] >= 4)
    if closes.any():
        gap = v[:, 0] + v[:, 2] - v[:, 1] - v[:, min(3, v.shape[1] - 1)]
        closes &= np.linalg.norm(gap, axis=1) <= 1e-9 * np.ptp(v, axis=1).max(axis=1)
    side = np.sqrt(2 * limits)
    runs = {}
    for length in np.unique(counts[~closes]):
        rows = np.flatnonzero(~closes & (counts == length))
        fan = np.stack(
            [np.stack([v[rows, 0], v[rows, k], v[rows, k + 1]], axis=1) for k in range(1, length - 1)], axis=1
        )
        triangles.append(fan.reshape(-1, 3, 3))
        order.append(np.repeat(rows, length - 2))
    for row in np.flatnonzero(closes):
        a, b, d = v[row, 0], v[row, 1], v[row, 3]
        nu = max(1, math.ceil(np.linalg.norm(b - a) / side[row] - 1e-9))
        nv = max(1, math.ceil(np.linalg.norm(d - a) / side[row] - 1e-9))
        while np.linalg.norm(polygons.cross(b - a, d - a)) / (nu * nv) > 2 * limits[row] * (1 + 1e-9):
            nu, nv = nu + 1, nv + 1
        run = Grid(0, nu, nv, a, (b - a) / nu, (d - a) / nv)
        triangles.append(run.triangles)
        order.append(np.full(2 * nu * nv, row))
        runs[int(row)] = run
    parent = np.concatenate(order)
    vertices = np.concatenate(triangles)
    arranged = np.argsort(parent, kind="stable")
    cut = halve(Triangles(vertices[arranged], parent[arranged]), limits)
    grids = tuple(replace(run, first=int(np.searchsorted(cut.parent, row))) for row, run in runs.items())
    return Triangles(cut.vertices, cut.parent, grids)


def _estimated_faces(pieces: np.ndarray, counts: np.ndarray, limits: np.ndarray) -> float:
    """About how many triangles `cut_pieces` would make; it knows that strips get cells no longer than wide."""
    with np.errstate(over="ignore"):
        by_area = np.maximum(counts - 2, polygons.areas(pieces) / limits)
        if pieces.shape[1] < 4:
            return float(by_area.sum())
        sides = pieces[:, [1, 3]] - pieces[:, :1]
        cells = np.ceil(np.linalg.norm(sides, axis=2) / np.sqrt(2 * limits)[:, None]).prod(axis=1)
        return float(np.where(counts == 4, np.maximum(by_area, 2 * cells), by_area).sum())


def _check_count(planes: Planes, is_cut: np.ndarray, limits: np.ndarray, area: float) -> None:
    """Refuse more faces than can be meant, before any is cut."""
    expected = _estimated_faces(planes.given, planes.given_counts, limits)
    most = max(MOST_FACES, 2 * int((planes.given_counts - 2).sum()))  # faces as given are never too many
    if expected <= most:
        return
    enough = area / MOST_FACES
    while _estimated_faces(planes.given, planes.given_counts, np.where(is_cut, enough, math.inf)) > most:
        enough *= 1.25
    raise SceneError(
        f"max_area {limits.min():g} m² would cut the scene into some {expected:.2g} faces, more than {most:,}; "
        f"raise it to {1.06 * enough:.2g} m² or more"  # two digits round by at most 5 %
    )


def halve(triangles: Triangles, limits) -> Triangles:
    """Halve triangles across their longest edge until none is larger than its parent's limit.

    Parameters
    ----------
    triangles : Triangles
    limits : (parents,) float [m²]

    Returns
    -------
    Triangles
        In the order of their parents.
    """
    vertices, parent = triangles.vertices, triangles.parent
    limits = np.asarray(limits, float)
    done_vertices, done_parent = [vertices[:0]], [parent[:0]]
    while len(vertices):
        large = polygons.areas(vertices) > limits[parent] * (1 + 1e-9)
        done_vertices.append(vertices[~large])
        done_parent.append(parent[~large])
        vertices, parent = vertices[large], parent[large]
        if not len(vertices):
            break
        edges = np.linalg.norm(np.roll(vertices, -1, axis=1) - vertices, axis=2)
        turn = (np.argmax(edges, axis=1)[:, None] + np.arange(3)) % 3
        a, b, c = np.moveaxis(np.take_along_axis(vertices, turn[:, :, None], axis=1), 1, 0)
        middle = 0.5 * (a + b)
        vertices = np.stack([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)], axis=1).reshape(
            -1, 3, 3
        )
        parent = np.repeat(parent, 2)
    vertices, parent = np.concatenate(done_vertices), np.concatenate(done_parent)
    order = np.argsort(parent, kind="stable")
    return Triangles(vertices[order], parent[order])


@dataclass(frozen=True, eq=False)
class Fracture:
    """Faces and elements of a scene; the faces' backs follow their fronts where a surface is two-sided.

    Attributes
    ----------
    faces : (f, 3, 3) float
        Triangles reported to the user, relative to the scene's centre.
    face_surface, face_source : (f,) int
        Surface, and face of it as given, that each is a part of.
    face_areas : (f,) float [m²]
    face_normals : (f, 3) float
    back_of : (b,) int
        Faces whose backs are receivers as well.
    elements : (e, 3, 3) float
        Triangles whose centroids receive; each a part of one face's front or back.
    element_side : (e,) int
        Face of each front element; number of faces plus index into ``back_of`` for a back's.
    element_sheet : (e,) int
        Sheet, plus the number of sheets for backs.
    element_areas : (e,) float [m²]
    grids : tuple of Grid
        Runs of elements that are halves of cells.
    """

    faces: np.ndarray
    face_surface: np.ndarray
    face_source: np.ndarray
    face_areas: np.ndarray
    face_normals: np.ndarray
    back_of: np.ndarray
    elements: np.ndarray
    element_side: np.ndarray
    element_sheet: np.ndarray
    element_areas: np.ndarray
    grids: tuple[Grid, ...]

    @cached_property
    def blocks(self) -> tuple[np.ndarray, np.ndarray]:
        """Cells looked at as one: a number for elements of such ``(e,)``, -1 for others; and their middle elements.

        The latter are the halves of the cell in the middle of each, ``(blocks, 2)``.
        """
        block, middle, count = np.full(len(self.elements), -1), [np.zeros((0, 2), np.int64)], 0
        for grid in self.grids:
            across, along = grid.spacing
            if across * along == 1:
                continue
            row, column, _ = np.indices((grid.rows, grid.columns, 2)).reshape(3, -1)
            high, wide = -(-grid.rows // across), -(-grid.columns // along)  # the last may be smaller
            block[grid.elements] = count + row // across * wide + column // along
            row, column = np.indices((high, wide)).reshape(2, -1)
            row = np.minimum(row * across + across // 2, grid.rows - 1)
            cell = row * grid.columns + np.minimum(column * along + along // 2, grid.columns - 1)
            middle.append(grid.first + 2 * cell[:, None] + [0, 1])
            count += len(cell)
        return block, np.concatenate(middle)

    @property
    def element_surface(self) -> np.ndarray:
        """(e,) int: surface of each element."""
        return np.concatenate([self.face_surface, self.face_surface[self.back_of]])[self.element_side]

    @property
    def sides(self) -> int:
        """Number of fronts and backs."""
        return len(self.faces) + len(self.back_of)

    def side_means(self, values) -> np.ndarray:
        """Area-weighted means over faces' fronts and backs ``(sides, ...)`` of values per element ``(e, ...)``."""
        mean = np.bincount(self.element_side, weights=self.element_areas * values, minlength=self.sides)
        return mean / self._side_areas

    @cached_property
    def _side_areas(self) -> np.ndarray:
        """(sides,) float [m²]."""
        return np.bincount(self.element_side, weights=self.element_areas, minlength=self.sides)


def fracture(
    planes: Planes,
    cut,
    reflects,
    two_sided,
    max_area: float | None,
    times: float = 1.0,
    wanted=True,
    luminous=None,
) -> Fracture:
    """Cut the scene's planes into faces and elements.

    Parameters
    ----------
    planes : Planes
    cut : (surfaces,) bool
        Surfaces to cut into faces; others are never cut for their size alone.
    reflects : (surfaces,) bool
        Surfaces that reflect diffusely: their elements are kept small.
    two_sided : (surfaces,) bool
    max_area : float or None
        Largest area of a face [m²]; None = chosen for the scene; inf = faces as given, only triangulated.
    times : float
        How many times as many faces and elements as usual, where the number is chosen here.
    wanted : (surfaces,) bool, or True for all
        Surfaces whose faces are reported; others' are not cut. Faces are of the size that they would have with all.
    luminous : (surfaces,) bool, optional
        Surfaces that give light of their own.

    Returns
    -------
    Fracture

    Raises
    ------
    SceneError
        Where the faces would be more than `MOST_FACES`.
    """
    surface = planes.sheet_surface[planes.given_sheet]
    piece_areas = polygons.areas(planes.given)
    is_cut = np.asarray(cut)[surface]
    total = piece_areas[is_cut].sum()
    limit = total / (DEFAULT_FACES * times) if max_area is None else max_area
    is_cut &= np.broadcast_to(wanted, len(planes.surfaces))[surface]
    limits = np.where(is_cut, limit if total else math.inf, math.inf)
    _check_count(planes, is_cut, limits, total)
    faces = cut_pieces(planes.given, planes.given_counts, limits)
    face_surface = surface[faces.parent]
    surface_area = np.bincount(surface, weights=piece_areas, minlength=len(planes.surfaces))
    reflecting = surface_area[np.asarray(reflects)].sum()
    fine = (
        np.where(np.asarray(reflects), reflecting / FEWEST_ELEMENTS, surface_area / ELEMENTS_PER_PLAIN_SURFACE) / times
    )
    sheet = planes.given_sheet[faces.parent]
    glows = np.zeros(len(planes.surfaces), bool) if luminous is None else np.asarray(luminous)
    wide = _wide_at_most(faces.grids, planes, sheet, np.asarray(two_sided), glows)
    parts = _elements(faces, fine[face_surface], wide / math.sqrt(times), len(planes.outlines))
    back_of = np.flatnonzero(np.asarray(two_sided)[face_surface])
    place = np.full(len(faces.parent), -1)
    place[back_of] = len(faces.parent) + np.arange(len(back_of))
    behind = np.flatnonzero(place[parts.parent] >= 0)
    side = np.concatenate([parts.parent, place[parts.parent[behind]]])
    element_sheet = np.concatenate([sheet[parts.parent], sheet[parts.parent[behind]] + len(planes.sheet_surface)])
    elements = np.concatenate([parts.vertices, parts.vertices[behind][:, ::-1]])
    grids = []
    for grid in parts.grids:
        grids.append(grid)
        if place[parts.parent[grid.first]] >= 0:
            grids.append(replace(grid, first=len(parts.parent) + int(np.searchsorted(behind, grid.first))))
    return Fracture(
        faces=faces.vertices,
        face_surface=face_surface,
        face_source=planes.given_source[faces.parent],
        face_areas=faces.areas,
        face_normals=planes.sheet_normal[sheet],
        back_of=back_of,
        elements=elements,
        element_side=side,
        element_sheet=element_sheet,
        element_areas=polygons.areas(elements),
        grids=tuple(grids),
    )


def _wide_at_most(grids, planes: Planes, sheet, two_sided, luminous) -> np.ndarray:
    """(runs, 2) float: how wide cells may be along either axis for what is near [m], of the largest runs at least."""
    wide = np.full((len(grids), 2), np.inf)
    glows = luminous[planes.sheet_surface[planes.outline_sheet]]
    area = np.array([grid.sides.prod() * grid.rows * grid.columns for grid in grids])
    for k in np.argsort(-area, kind="stable")[: max(1, _MOST_TESTS // len(planes.outlines))]:
        mine = sheet[grids[k].first]
        for side in (1.0, -1.0) if two_sided[planes.sheet_surface[mine]] else (1.0,):
            wide[k] = np.minimum(wide[k], closeness(grids[k], planes, side * planes.sheet_normal[mine], glows))
    return wide


def _divisions(grids, areas, limits, wide, outlines: int) -> tuple[np.ndarray, np.ndarray]:
    """(runs,) int and (runs, 2) int: what cells' sides are divided by, and what either side alone would be."""
    sides = np.array([grid.sides for grid in grids]).reshape(-1, 2)
    first = np.array([grid.first for grid in grids], np.int64)
    # both axes are divided alike, as the faces' diagonal has to stay one: long cells need more
    slender = np.minimum(sides.max(axis=1) / sides.min(axis=1), _MOST_SLENDER)
    plain = np.maximum(1, np.ceil(np.sqrt(slender * areas[first] / limits[first]) - 1e-9)).astype(int)
    cells = np.array([2 * grid.rows * grid.columns for grid in grids])
    most = min(MOST_FINER, max(MOST_FINER // max(outlines - 1, 1), TIMES_FINER * int((cells * plain**2).sum())))
    while True:
        alone = np.maximum(plain[:, None], np.rint(sides / wide).astype(int))
        times = alone.max(axis=1)
        if (cells * (times**2 - plain**2)).sum() <= most:
            return times, alone
        wide = 1.25 * wide


def _elements(faces: Triangles, limits: np.ndarray, wide: np.ndarray, outlines: int) -> Triangles:
    """Cut faces into elements no larger than limits ``(faces,)``: runs of cells into finer runs, others by halving.

    Runs get cells no wider than ``wide`` (runs, 2) [m] as well, so far as `MOST_FINER` allows.
    """
    areas = faces.areas
    alone = np.ones(len(areas), bool)
    found, parents, grids, count = [], [], [], 0
    divisions = _divisions(faces.grids, areas, limits, wide, outlines)
    for grid, times, enough in zip(faces.grids, *divisions, strict=True):
        cells = np.arange(grid.first, grid.first + 2 * grid.rows * grid.columns)
        if grid.rows * grid.columns * times**2 < _FEWEST_CELLS:
            continue  # too few cells to tell how light changes
        alone[cells] = False
        finer = Grid(
            count,
            grid.rows * int(times),
            grid.columns * int(times),
            grid.corner,
            grid.along_rows / times,
            grid.along_columns / times,
            tuple((times // enough).tolist()),
        )
        found.append(finer.triangles)
        parents.append(grid.first + _halves_of(finer, int(times)).ravel())
        grids.append(finer)
        count += len(parents[-1])
    single = np.flatnonzero(alone)
    halved = halve(Triangles(faces.vertices[single], np.arange(len(single))), limits[single])
    return Triangles(
        np.concatenate([*found, halved.vertices]), np.concatenate([*parents, single[halved.parent]]), tuple(grids)
    )


def _halves_of(grid: Grid, times: int) -> np.ndarray:
    """(rows, columns, 2) int: triangle of the run that each of a finer run, ``times`` as fine, lies in."""
    row, column, half = np.indices((grid.rows, grid.columns, 2))
    cell = (row // times) * (grid.columns // times) + column // times
    across, along = row % times, column % times
    return 2 * cell + np.where(across == along, half, across < along)
