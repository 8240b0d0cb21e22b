"""Patches: groups of elements that share one exitance, laid out so that beams find them by place."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from . import polygons
from .grid import ON_LINE, Grid
from .layout import Layout
from .planes import Planes
from .profiles import Profile, profile_shares

_WIDEST = 1.0
"""Side of the widest patch of a run, over that of a patch of average area."""

_GROWTH = 0.4
"""Growth of patches with the distance from the end of a stretch."""

_FINEST, _NEAR_ENOUGH, _ASKEW = 64, 2e-3, 32
"""Parts of a cell that are told apart at most where a line of contact cuts it; how much farther off than with the best
number of parts the line may be, in cells; and parts where it runs askew."""

_MOST_PLACES = 1_000_000
"""Parts of one run's cells that are told apart."""

_WHOLE = 0.9
"""Share of a sheet's breadth that lines of contact along one place make up, where they part it in two."""

_MOST_PARTED = 500
"""Sheets smaller than a patch, of which it is asked whether a line of contact parts them."""

_WALL, _MOST_WALLS = 4.0, 200
"""Area of outlines that part small sheets on either side of them, in average patches; and how many of them do."""

_ACROSS = 3
"""Cells across a narrow strip from which it has patches of its own, however small: what it sends, and is seen of it by
the next, is not even across."""

_MOST_STRIPS = 160
"""Such strips: where there are more, these would be most of all patches."""

_PARTS = 20
"""Columns across a narrow strip, about: an odd number, as whole slats far away are seen at their middle."""


@dataclass(frozen=True, eq=False)
class Patches:
    """Groups of elements that share one exitance, with a grid per sheet to find them by.

    The backs of two-sided sheets follow the fronts: sheet number plus the number of sheets.

    Attributes
    ----------
    count : int
    of_element : (e,) int
        Patch of each element, -1 where it has none (its surface neither emits nor reflects diffusely).
    grid_origin, grid_scale : (2s, 2) float
        Cell of an in-plane point: floor((axes · x − origin) · scale).
    grid_shape : (2s, 2) int
    grid_base : (2s,) int
        Where the sheet's cells begin in ``grid``; -1 for a sheet without patches.
    grid : (cells,) int
        Column of each cell: its patch, or a part of one across a narrow strip.
    narrow : (2s,) int
        Axis that runs across a sheet which is such a strip; -1 for others.
    profiles : tuple of Profile
        What the columns after the patches are parts of.
    """

    count: int
    of_element: np.ndarray
    grid_origin: np.ndarray
    grid_scale: np.ndarray
    grid_shape: np.ndarray
    grid_base: np.ndarray
    grid: np.ndarray
    narrow: np.ndarray
    profiles: tuple[Profile, ...] = ()

    @property
    def columns(self) -> int:
        """What beams can end on: patches, and parts of them across narrow strips."""
        return self.count + sum(p.along * len(p.shares) for p in self.profiles)

    def sums(self, values: np.ndarray) -> np.ndarray:
        """(p,) float: sums over each patch's elements of values ``(e,)``."""
        mine = self.of_element >= 0
        return np.bincount(self.of_element[mine], weights=values[mine], minlength=self.count).astype(float)

    def sheets(self, element_sheet: np.ndarray) -> np.ndarray:
        """(p,) int: a sheet that each patch lies on, of those of the elements ``(e,)``."""
        sheet = np.zeros(self.count, np.int64)
        mine = self.of_element >= 0
        sheet[self.of_element[mine]] = element_sheet[mine]
        return sheet

    def merged(self, grids: tuple[Grid, ...], element_sheet: np.ndarray) -> np.ndarray:
        """(p,) int: groups of patches that lie beside each other, twice as wide as they are.

        Parameters
        ----------
        grids : tuple of Grid
            Runs of elements, whose patches are merged in fours; others in twos, as they are numbered in their sheet.
        element_sheet : (e,) int
        """
        sheet = self.sheets(element_sheet)
        first = np.searchsorted(sheet, sheet) if (np.diff(sheet) >= 0).all() else np.zeros(self.count, np.int64)
        key = np.stack([sheet, (np.arange(self.count) - first) // 2, np.full(self.count, -1)])
        for grid in grids:
            patch = self.of_element[grid.elements][::2].reshape(grid.rows, grid.columns)
            line, column = (np.cumsum(np.diff(p, prepend=p[0]) != 0) // 2 for p in (patch[:, 0], patch[0]))
            key[1:, patch] = np.broadcast_arrays(line[:, None], column)
        return np.unique(key, axis=1, return_inverse=True)[1].reshape(-1)

    def folded(self, columns: np.ndarray) -> np.ndarray:
        """(r, p) float: form factors to patches from those to columns ``(r, c)``."""
        patches = columns[:, : self.count]
        for profile in self.profiles:
            profile.fold(columns, patches)
        return patches


def make_patches(
    planes: Planes, elements, element_sheet, element_active, areas, target: int, lattices: list[Layout]
) -> Patches:
    """Gather elements into patches of about equal area.

    Sheets that are one run of cells get patches as fine as their lattice says, other large ones an even grid. Small
    ones (curved meshes) are gathered by place, facing and surface. Where other surfaces touch a sheet patches end.

    Parameters
    ----------
    planes : Planes
    elements : (e, 3, 3) float
    element_sheet : (e,) int
    element_active : (e,) bool
        Whether the element can emit diffuse light.
    areas : (e,) float [m²]
    target : int
        About how many patches to make.
    lattices : list of Layout

    Returns
    -------
    Patches
    """
    fronts = len(planes.sheet_surface)
    sheets = 2 * fronts
    centroids = elements.mean(axis=1)
    of_element = np.full(len(centroids), -1, np.int64)
    origin, scale = np.zeros((sheets, 2)), np.zeros((sheets, 2))
    shape, base = np.ones((sheets, 2), np.int64), np.full(sheets, -1, np.int64)
    narrow = np.full(sheets, -1, np.int64)
    active = np.flatnonzero(element_active)
    if not len(active):
        return Patches(0, of_element, origin, scale, shape, base, np.zeros(0, np.int64), narrow)
    patch_area = areas[active].sum() / target
    order = active[np.argsort(element_sheet[active], kind="stable")]
    used, starts = np.unique(element_sheet[order], return_index=True)
    sheet_area = np.add.reduceat(areas[order], starts)
    bounds = np.append(starts, len(order))
    runs = {int(element_sheet[lattice.grid.first]): lattice for lattice in lattices}
    strips = {sheet for sheet, lattice in runs.items() if _is_strip(lattice.grid, patch_area)}
    if len(strips) > _MOST_STRIPS:
        strips.clear()
    is_small = sheet_area <= 1.5 * patch_area
    asked = np.count_nonzero(is_small) <= _MOST_PARTED
    grid, cells, count, parts = [], 0, 0, 0
    profiles: list[Profile] = []
    small = []
    for k, sheet in enumerate(used):
        members = order[bounds[k] : bounds[k + 1]]
        few = is_small[k] and sheet not in strips
        if len(members) == 1 or (few and not asked):
            small.append(k)
            continue
        place = centroids[members] @ planes.sheet_axes[sheet % fronts].T
        # the outline's extent, not the centroids', so that cells are of even size
        outline = (
            planes.outlines[planes.outline_sheet == sheet % fronts].reshape(-1, 3) @ planes.sheet_axes[sheet % fronts].T
        )
        low, extent = outline.min(axis=0), np.maximum(np.ptp(outline, axis=0), 1e-300)
        run = runs.get(int(sheet))
        if few:
            axes = planes.sheet_axes[sheet % fronts]
            layout = Layout.over(int(sheet), (1, 1), axes, low, extent, planes) if run is None else run
            if not _is_parted(layout):
                small.append(k)
                continue
            run = None
        if run is not None and _make_up(run, members, in_cells := run.grid.in_cells(centroids[members])):
            graded = _graded(run, planes.sheet_axes[sheet % fronts], low, extent, patch_area, in_cells)
            if graded is not None:
                patch, table, shares = graded
                shape[sheet], base[sheet] = table.shape, cells
                origin[sheet], scale[sheet] = low, shape[sheet] / extent
                of_element[members] = count + patch
                if shares is None:
                    grid.append(count + table.ravel())
                else:
                    grid.append(-1 - parts - table.ravel())  # until the number of all patches is known
                    along = (int(patch.max()) + 1) // shares.shape[1]
                    profiles.append(Profile(parts, count, along, shares))
                    parts += along * len(shares)
                    narrow[sheet] = int(np.argmin(extent))
                cells, count = cells + table.size, count + int(patch.max()) + 1
                continue
        corners = (elements[members] @ planes.sheet_axes[sheet % fronts].T - low) / extent
        n = np.array([_cells_along(corners[:, :, k], extent[k] / math.sqrt(patch_area)) for k in (0, 1)])
        while n.prod() > 4 * len(members):
            n = np.maximum(1, n // 2)
        origin[sheet], scale[sheet], shape[sheet], base[sheet] = low, n / extent, n, cells
        layout = Layout.over(int(sheet), n, planes.sheet_axes[sheet % fronts], low, extent, planes)
        in_cells = (place - low) * scale[sheet]
        filled, patch = np.unique(layout.cell_of(in_cells), return_inverse=True)
        patch, table = patch.reshape(-1), _fill_cells(filled, n)
        if layout.cut.any():
            finer = _fine_enough(layout)
            patch, table = _by_side(layout, table.reshape(n), in_cells, finer)
            shape[sheet], scale[sheet] = table.shape, table.shape / extent
        of_element[members] = count + patch
        grid.append(count + table.ravel())
        cells += table.size
        count += int(patch.max()) + 1
    if small:
        count = _gather_small(
            planes,
            centroids,
            [(used[k], order[bounds[k] : bounds[k + 1]]) for k in small],
            sheet_area[small].sum(),
            patch_area,
            of_element,
            count,
        )
        for k in small:
            sheet = used[k]
            base[sheet] = cells
            grid.append(of_element[order[bounds[k] : bounds[k] + 1]])
            cells += 1
    column = np.concatenate(grid)
    column = np.where(column < 0, count - 1 - column, column)
    after = tuple(replace(p, first_column=count + p.first_column) for p in profiles)
    return Patches(count, of_element, origin, scale, shape, base, column, narrow, after)


def _is_strip(grid: Grid, patch_area: float) -> bool:
    """Whether a run is narrower than a patch and longer, and cut across all the same, as others lie close to it."""
    widths = grid.sides * grid.shape
    across = grid.shape[int(np.argmin(widths))]
    return bool(across >= _ACROSS and widths.max() > 2 * math.sqrt(patch_area) > 4 * widths.min())


def _is_parted(layout: Layout) -> bool:
    """Whether lines of contact along one place reach from border to border: the sides may be lit quite differently."""
    across = np.abs(layout.contacts[:, 1] - layout.contacts[:, 0])
    for axis, length in ((0, layout.grid.columns), (1, layout.grid.rows)):
        mine = across[:, axis] < ON_LINE
        _, place = np.unique(np.round(layout.contacts[mine, 0, axis], 6), return_inverse=True)
        if (np.bincount(place.reshape(-1), weights=across[mine, 1 - axis]) > _WHOLE * length).any():
            return True
    return False


def _make_up(layout: Layout, members: np.ndarray, in_cells: np.ndarray) -> bool:
    """Whether elements of a sheet, at places ``(k, 2)``, are a run's, with what its cut cells are divided into."""
    run = layout.grid.elements
    own = (members >= run.start) & (members < run.stop)
    inside = (in_cells[~own] > 0).all() and (in_cells[~own] < layout.grid.shape).all()
    whole = np.count_nonzero(own) == run.stop - run.start
    return bool(whole and inside and layout.cut.ravel()[layout.cell_of(in_cells[~own])].all())


def _graded(
    lattice: Layout, axes, low, extent, patch_area: float, in_cells: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray | None] | None:
    """Patches of a run's elements at places ``(k, 2)``, and by place along the sheet's axes; None where it lies askew.

    Across a strip narrower than a patch the latter are numbers of parts, and third is what these are of patches.
    """
    grid = lattice.grid
    along = np.abs(axes @ np.stack([grid.along_rows, grid.along_columns], axis=1))
    if np.minimum(along[0], along[1]).max() > 1e-6 * along.max():
        return None
    side = math.sqrt(patch_area)
    groups = [
        _groups(stretches, max(1, round(_WIDEST * side / float(cell))), spacing)
        for stretches, cell, spacing in zip(lattice.stretches, grid.sides, grid.spacing, strict=True)
    ]
    counts = [int(group.max()) + 1 for group in groups]
    widths = grid.sides * grid.shape
    axis = int(np.argmin(widths))
    patch, finer, shares = groups[0][:, None] * counts[1] + groups[1], [1, 1], None
    numbers = patch
    if widths[axis] < side and counts[axis] > 1 and not _cut_along(lattice, axis):
        finer[axis] = max(1, _PARTS // (2 * grid.shape[axis])) * 2 + 1
        shares = profile_shares(groups[axis], lattice.stretches[axis], finer[axis])
        numbers = groups[1 - axis][:, None] * len(shares) + np.arange(len(shares))
        patch = groups[1 - axis][:, None] * counts[axis] + groups[axis]
        numbers, patch = (numbers, patch) if axis == 1 else (numbers.T, patch.T)
    of_element = patch.ravel()[lattice.cell_of(in_cells)]
    if shares is None and lattice.cut.any():
        finer = _fine_enough(lattice)
        of_element, numbers = _by_side(lattice, patch, in_cells, finer)
    rows, columns = np.indices(numbers.shape)
    centre = (
        grid.corner
        + ((rows[:, :, None] + 0.5) / finer[0]) * grid.along_rows
        + ((columns[:, :, None] + 0.5) / finer[1]) * grid.along_columns
    )
    shape = np.array(numbers.shape if along[0, 0] > along[1, 0] else numbers.shape[::-1])
    place = np.clip(((centre @ axes.T - low) * (shape / extent)).astype(int), 0, shape - 1)
    table = np.zeros(shape, np.int64)
    table[place[:, :, 0], place[:, :, 1]] = numbers
    return of_element, table, shares


def _cut_along(lattice: Layout, axis: int) -> bool:
    """Whether a line of contact runs through the middle of cells at one place of an axis."""
    one, other = lattice.contacts[:, 0, axis], lattice.contacts[:, 1, axis]
    return bool(((np.abs(one - other) < ON_LINE) & (np.abs(one - np.rint(one)) > ON_LINE)).any())


def _fine_enough(layout: Layout) -> list[int]:
    """In how many parts cells have to be told apart along either axis, so that lines of contact run between them."""
    step = np.abs(layout.contacts[:, 1] - layout.contacts[:, 0])
    askew = bool((step.min(axis=1) >= ON_LINE).any())
    finest = _FINEST
    while True:
        finer = [_parts(layout.contacts[step[:, axis] < ON_LINE, 0, axis], askew, finest) for axis in (0, 1)]
        if layout.cut.size * math.prod(finer) <= _MOST_PLACES or finest == 1:
            return finer
        finest //= 2


def _parts(places: np.ndarray, askew: bool, finest: int) -> int:
    """Parts of each cell, as few as do, between which lines at these places, in cells, run."""
    places = places[np.abs(places - np.rint(places)) > ON_LINE] % 1
    least = min(_ASKEW, finest) if askew else 1
    if finest == 1 or not len(places):
        return least
    parts = np.arange(max(2, least), finest + 1)
    off = np.abs(places[:, None] - np.clip(np.rint(places[:, None] * parts), 1, parts - 1) / parts).max(axis=0)
    return int(parts[np.argmax(off <= off.min() + _NEAR_ENOUGH)])


def _by_side(
    lattice: Layout, patch: np.ndarray, in_cells: np.ndarray, finer: list[int]
) -> tuple[np.ndarray, np.ndarray]:
    """Patches of cells, divided by lines of contact: those of elements at places ``(k, 2)``, and of parts of cells."""
    if max(finer) == 1:
        return patch.ravel()[lattice.cell_of(in_cells)], patch
    along = [(np.arange(count * parts) + 0.5) / parts for count, parts in zip(patch.shape, finer, strict=True)]
    places = np.stack(np.meshgrid(*along, indexing="ij"), axis=2)
    every = np.concatenate([in_cells, places.reshape(-1, 2)])
    side = lattice.sides(every)
    sides = int(side.max()) + 1
    key = patch.ravel()[lattice.cell_of(every)] * sides + side
    mine, there = key[: len(in_cells)], key[len(in_cells) :].reshape(places.shape[:2])
    # slivers too narrow for a place of their own get the one in their middle
    narrow = np.flatnonzero(~np.isin(mine, there))
    row, column = np.floor(in_cells[narrow] * finer).astype(int).T
    there[row, column] = mine[narrow]
    # places that no element is found by are of the next side of their patch
    known = np.unique(mine)
    of_patch = there // sides
    following = known[np.minimum(np.searchsorted(known, there), len(known) - 1)]
    first = known[np.searchsorted(known, of_patch * sides)]
    there = np.where(following // sides == of_patch, following, first)
    return np.searchsorted(known, mine), np.searchsorted(known, there)


def _groups(stretches: list, most: int, spacing: int = 1) -> np.ndarray:
    """(cells,) int: group of each cell along one axis: narrow at the ends of stretches, ``most`` cells in between.

    ``spacing`` cells count as one where they fill a stretch.
    """
    sizes = []
    for _, count in stretches:
        if spacing > 1 and count % spacing == 0:
            groups = _groups([(0, count // spacing)], max(1, round(most / spacing)))
            sizes += (spacing * np.bincount(groups)).tolist()
            continue
        half: list[int] = []
        left = count
        while left > 0:
            size = min(most, 1 + int(_GROWTH * sum(half)))
            if 2 * size >= left:
                middle = [left] if left <= size else [left // 2, left - left // 2]
                sizes += [*half, *middle, *reversed(half)]
                break
            half.append(size)
            left -= 2 * size
    return np.repeat(np.arange(len(sizes)), sizes)


def _cells_along(places: np.ndarray, wanted: float) -> int:
    """Number of cells along one axis, near ``wanted``: where possible one whose limits no element straddles.

    A patch's mean is then that of just the area that beams find it by.
    """
    target = max(1, round(wanted))
    low, high = places.min(axis=1), places.max(axis=1)
    for n in sorted(range(max(1, target // 2), 2 * target + 1), key=lambda n: abs(math.log(n / max(wanted, 1e-9)))):
        if (np.floor(low * n + 1e-6) >= np.floor(high * n - 1e-6)).all():
            return n
    return target


def _gather_small(planes, centroids, groups, small_area, patch_area, of_element, count) -> int:
    sheet_of = np.array([sheet for sheet, _ in groups])
    middle = np.array([centroids[members].mean(axis=0) for _, members in groups])
    fronts = len(planes.sheet_surface)
    back = sheet_of >= fronts
    normal = planes.sheet_normal[sheet_of % fronts] * np.where(back, -1.0, 1.0)[:, None]
    facing = np.argmax(np.abs(normal), axis=1) * 2 + (
        np.take_along_axis(normal, np.argmax(np.abs(normal), axis=1)[:, None], 1)[:, 0] > 0
    )
    fair = 8 + 4 * round(small_area / patch_area)
    side = math.sqrt(patch_area)
    while True:
        key = np.c_[planes.sheet_surface[sheet_of % fronts], back, facing, np.floor(middle / side)]
        distinct, patch = np.unique(key, axis=0, return_inverse=True)
        one_cell = len(np.unique(key[:, 3:], axis=0)) == 1
        if len(distinct) <= fair or one_cell:
            break
        side *= 2  # leaves far apart share a patch
    patch = _divided_by_walls(planes, patch.reshape(-1), middle, side * distinct[:, 3:], side, patch_area)
    for number, (_, members) in zip(patch, groups, strict=True):
        of_element[members] = count + number
    return count + int(patch.max()) + 1


def _divided_by_walls(
    planes: Planes, patch: np.ndarray, places: np.ndarray, corners: np.ndarray, side: float, patch_area: float
):
    """(k,) int: patches of places ``(k, 3)`` in cubes from ``corners`` on, those on either side of a wall apart."""
    area = polygons.areas(planes.outlines)
    walls = np.argsort(-area, kind="stable")[: min(_MOST_WALLS, np.count_nonzero(area > _WALL * patch_area))]
    key = np.zeros(len(places))
    for wall, weight in zip(walls, np.random.default_rng(0).random(len(walls)), strict=True):
        outline, normal = planes.outlines[wall], planes.sheet_normal[planes.outline_sheet[wall]]
        offset = outline[0] @ normal
        near = (corners <= outline.max(axis=0)).all(axis=1) & (corners + side >= outline.min(axis=0)).all(axis=1)
        near &= np.abs((corners + 0.5 * side) @ normal - offset) <= 0.5 * side * np.abs(normal).sum()
        if near.any():
            mine = near[patch]
            key[mine] += weight * (places[mine] @ normal - offset > 1e-9 * planes.size)
    return np.unique(np.c_[patch, key], axis=0, return_inverse=True)[1].reshape(-1)


def _fill_cells(filled: np.ndarray, n: np.ndarray) -> np.ndarray:
    """(cells,) int: for each cell of a grid the nearest filled one's number."""
    if len(filled) == n.prod():
        return np.arange(len(filled))
    every = np.stack(np.unravel_index(np.arange(n.prod()), n), axis=1)
    distance = ((every[:, None] - every[filled][None]) ** 2).sum(axis=2)
    return np.argmin(distance, axis=1)
