"""Nodes: the few receivers that all elements' values follow from.

Form factors vary evenly over a plane but for the lines where something touches it, and near openings. So a regular run
of cells is given receivers on a lattice, dense at its borders and beside lines of contact, wide in between, and its
elements get their values by cubic interpolation that never reaches across a line of contact. Elements of cells that
such a line cuts have receivers of their own; so have those where interpolation is in doubt, once that shows.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from . import polygons
from .clusters import MANY_FACETS, clustered
from .fracture import Fracture
from .layout import Layout
from .stencils import left_out, lines_along, stencils
from .weights import Weights

DOUBT = 0.07
"""Surprise of a node (`Nodes.doubt`), relative to all light, from which the elements around get their own receivers."""

_SURE = 0.25
"""How much of that is allowed where the lattice reaches across a line of contact askew to it: light may end there."""

_CURVE = 0.1
"""Error of one receiver for an element, over the difference between the halves of its cell."""

_FEWEST_OWN = 1_000
"""Elements in doubt that may always have receivers of their own; no more than the lattice has where that is more."""

_FACET = 2
"""Elements of a plane that counts as a facet."""

_SHARED = 6_000
"""Receivers that they share where there are more, about."""

_MOST_SPLITS = 3
_FEWEST_SPLITS = 100

STEEP = 0.25
"""Difference between the halves of a cell, relative to all light, from which several receivers serve each."""


@dataclass(frozen=True, eq=False)
class Nodes:
    """Receivers, and how elements' values follow from theirs.

    Attributes
    ----------
    points : (m, 3) float
    element : (m,) int
        An element in whose plane each lies.
    element_sheet : (e,) int
    weights : Weights
        Elements' values from the nodes'.
    around : Weights
        The nodes next to each element on the lattice; its own where it has such.
    centres : Weights
        The lattice's values in the middle of cells, some of which are looked at as one; by the first half of each.
    foretold : list of Weights
        What the nodes of the lattice would have if their neighbours along one axis, or the other, told it.
    shared : (s,) int
        Nodes that stand for several facets, which do not lie in one plane.
    askew : (e,) bool
        Elements whose nodes may lie on the other side of a line of contact, askew to the lattice.
    """

    points: np.ndarray
    element: np.ndarray
    element_sheet: np.ndarray
    weights: Weights
    around: Weights
    centres: Weights
    foretold: list[Weights]
    shared: np.ndarray
    askew: np.ndarray

    @property
    def sheet(self) -> np.ndarray:
        """(m,) int, as `Fracture.element_sheet`."""
        return self.element_sheet[self.element]

    @classmethod
    def of(cls, fracture: Fracture, lattices: list[Layout]) -> Nodes:
        """The lattice of a scene, and own receivers for elements that lie in no run, or in a cell that is cut."""
        entries = _Entries()
        alone = np.ones(len(fracture.elements), bool)
        for lattice in lattices:
            _enter(lattice, entries)
            alone[lattice.grid.elements] = np.repeat(lattice.cut.ravel(), 2)
        single = np.flatnonzero(alone)
        facets = np.bincount(fracture.element_sheet[single])[fracture.element_sheet[single]] <= _FACET
        if np.count_nonzero(facets) > MANY_FACETS:
            entries.shared(single[facets], fracture)
            single = single[~facets]
        entries.own(single, fracture.elements[single].mean(axis=1), np.ones(len(single)))
        return entries.nodes(fracture.element_sheet)

    def on_elements(self, values: np.ndarray) -> np.ndarray:
        """(e,) float: elements' values, never negative, from values at the nodes ``(m,)`` that are not."""
        return np.maximum(self.weights.apply(values), 0.0)

    def doubt(self, values: np.ndarray) -> np.ndarray:
        """(e,) float: how far the nodes around each element are from what their neighbours foretell, over all light.

        A crease of the values, which no smooth interpolation follows, shows so, while an even curve does not.

        Parameters
        ----------
        values : (m, g) float
            Several kinds of light, none negative.
        """
        surprise = np.zeros(len(values))
        for foretold in self.foretold:
            apart = values[: len(foretold.start) - 1] - foretold.apply(values)
            apart = np.maximum(np.abs(apart).max(axis=1, initial=0.0), np.abs(apart.sum(axis=1)))
            surprise[: len(apart)] = np.maximum(surprise[: len(apart)], apart)
        surprise /= _all_light(values)
        return np.maximum.reduceat(surprise[self.around.node], self.around.start[:-1])

    def unsure(self, values: np.ndarray, fracture: Fracture) -> np.ndarray:
        """(e,) float: what interpolation, or one receiver for an area, leaves open, over all light; see `doubt`."""
        # a mean by n receivers errs by the light's curve, which is less than its slope, over n
        receivers = np.diff(self.weights.start)
        slope = _slopes(self.weights.apply(values), fracture) / np.maximum(receivers, 1)
        return self.doubt(values) + np.where((receivers > 0) & (receivers <= 4), _CURVE * slope, 0.0)

    def with_own(self, elements: np.ndarray, fracture: Fracture) -> Nodes:
        """With receivers of their own for some elements ``(k,)``.

        Elements of cells that are looked at as one share one, which raises or lowers what the lattice tells of them.
        """
        block, middle = fracture.blocks
        together = block[elements] >= 0
        together[together] = np.diff(self.centres.start)[middle[block[elements[together]], 0]] > 0
        alone, some = elements[~together], elements[together]
        blocks, place = np.unique(block[some], return_inverse=True)
        every = np.concatenate([alone, some])
        node = len(self.points) + np.concatenate([np.arange(len(alone)), len(alone) + place.reshape(-1)])
        own = every, node, np.ones(len(every))
        entries = [own]
        # an element's mean follows the lattice, raised or lowered by what this errs by at the receiver itself
        means, there = self.weights.of_rows(some), self.centres.of_rows(middle[block[some], 0])
        entries.append((some[means.rows], means.node, means.weight))
        entries.append((some[there.rows], there.node, -there.weight))
        return self._with(
            np.concatenate([alone, middle[blocks, 0]]),
            np.concatenate(
                [fracture.elements[alone].mean(axis=1), fracture.elements[middle[blocks]].mean(axis=(1, 2))]
            ),
            self.weights.replaced(*(np.concatenate(part) for part in zip(*entries, strict=True))),
            self.around.replaced(*own),
        )

    def with_split(self, pieces: _Pieces) -> tuple[Nodes, _Pieces]:
        """With four receivers for each of some pieces, and these in four."""
        parts = pieces.split(len(self.points))
        new = parts.node >= len(self.points)
        element, node = parts.element[new], parts.node[new]
        return (
            self._with(
                element,
                parts.triangle[new].mean(axis=1),
                self.weights.shared(pieces.node, element, node, parts.share[new]),
                self.around.shared(pieces.node, element, node, parts.share[new]),
            ),
            parts,
        )

    def _with(self, element, points, weights: Weights, around: Weights) -> Nodes:
        return Nodes(
            np.concatenate([self.points, points]),
            np.concatenate([self.element, element]),
            self.element_sheet,
            weights,
            around,
            self.centres,
            self.foretold,
            self.shared,
            self.askew,
        )


def settled(
    lattice: Nodes, fracture: Fracture, evaluate: Callable[[Nodes, int], np.ndarray], times: float = 1.0
) -> Nodes:
    """Add nodes to a lattice where interpolation is in doubt, and several for an element where light changes steeply.

    Parameters
    ----------
    lattice : Nodes
    fracture : Fracture
    evaluate : callable(nodes, first) -> (m, g) float
        Finds values at the nodes from ``first`` on, and gives those of all: several kinds of light, none negative.
    times : float
        How many times finer than usual.

    Returns
    -------
    Nodes
    """
    nodes, values = lattice, evaluate(lattice, 0)
    doubt = nodes.doubt(values)
    doubtful = np.flatnonzero(doubt > np.where(nodes.askew, _SURE, 1.0) * DOUBT / times)
    cost = _own_share(fracture)[doubtful]
    doubtful = _foremost(doubtful, doubt[doubtful], max(_FEWEST_OWN, len(lattice.points)), cost)
    if len(doubtful):
        first = len(nodes.points)
        nodes = nodes.with_own(doubtful, fracture)
        values = evaluate(nodes, first)
    pieces = _Pieces.steep(nodes, values, fracture, STEEP / times)
    for _ in range(_MOST_SPLITS):
        if not len(pieces.node):
            break
        first = len(nodes.points)
        nodes, pieces = nodes.with_split(pieces)
        values = evaluate(nodes, first)
        light = _all_light(nodes.weights.apply(values))
        pieces = pieces.uneven(values, light, STEEP / times, _most_pieces(lattice))
    return nodes


@dataclass(frozen=True, eq=False)
class _Pieces:
    """Triangles, parts of elements, with the node in the middle of each.

    Attributes
    ----------
    triangle : (k, 3, 3) float
    element, node : (k,) int
    share : (k,) float
        Of the element's area.
    """

    triangle: np.ndarray
    element: np.ndarray
    node: np.ndarray
    share: np.ndarray

    @classmethod
    def steep(cls, nodes: Nodes, values: np.ndarray, fracture: Fracture, steep: float) -> _Pieces:
        """Elements with one receiver of their own that the other half of their cell differs much from."""
        slope = _slopes(nodes.weights.apply(values), fracture)
        single = np.flatnonzero(np.diff(nodes.weights.start) == 1)
        node = nodes.weights.node[nodes.weights.start[single]]
        own = single[np.bincount(nodes.weights.node, minlength=len(nodes.points))[node] == 1]
        element = own[slope[own] > steep]
        element = _foremost(element, slope[element], _most_pieces(nodes))
        node = nodes.weights.node[nodes.weights.start[element]]
        return cls(fracture.elements[element], element, node, np.ones(len(element)))

    def split(self, first: int) -> _Pieces:
        """Each in four: the middle keeps the node, the corners get those from ``first`` on."""
        corners = self.triangle
        middles = 0.5 * (corners + np.roll(corners, -1, axis=1))
        before = np.roll(middles, 1, axis=1)
        outer = np.stack([corners, middles, before], axis=2)  # at each corner: itself, and both middles next to it
        inner = middles[:, None]
        count = len(self.node)
        return _Pieces(
            np.concatenate([inner, outer], axis=1).reshape(-1, 3, 3),
            np.repeat(self.element, 4),
            np.concatenate([self.node[:, None], first + np.arange(3 * count).reshape(-1, 3)], axis=1).ravel(),
            np.repeat(0.25 * self.share, 4),
        )

    def uneven(self, values: np.ndarray, light: np.ndarray, steep: float, most_pieces: int) -> _Pieces:
        """Of pieces split last, those that still differ among each other by more than their element can bear."""
        four = values[self.node].reshape(-1, 4, values.shape[1])
        apart = np.abs(four[:, 1:] - four[:, :1]).max(axis=(1, 2), initial=0.0)
        uneven = 4 * self.share[::4] * apart / (steep * light[self.element[::4]])
        chosen = _foremost(np.flatnonzero(uneven > 1), uneven[uneven > 1], most_pieces // 4)
        mine = np.repeat(np.isin(np.arange(len(uneven)), chosen), 4)
        return _Pieces(self.triangle[mine], self.element[mine], self.node[mine], self.share[mine])


def _all_light(values: np.ndarray) -> np.ndarray:
    """(n,) float: sums of several kinds of light ``(n, g)``, nowhere less than a thousandth of their mean."""
    total = values.sum(axis=1)
    return np.maximum(total, 1e-3 * max(float(total.mean()), 1e-300))


def _slopes(here: np.ndarray, fracture: Fracture) -> np.ndarray:
    """(e,) float: how far the halves of a cell lie apart, over all light there; 0 for elements of no cell."""
    slopes = np.zeros(len(here))
    for grid in fracture.grids:
        pair = here[grid.elements].reshape(-1, 2, here.shape[1])
        slopes[grid.elements] = np.repeat(np.abs(pair[:, 0] - pair[:, 1]).max(axis=1, initial=0.0), 2)
    return slopes / _all_light(here)


def _most_pieces(nodes: Nodes) -> int:
    """How many elements or pieces may be split at once: steep ones cost four times their number."""
    return max(_FEWEST_SPLITS, len(nodes.points) // 4)


def _own_share(fracture: Fracture) -> np.ndarray:
    """(e,) float: share of a receiver that each element would have of its own; cells looked at as one share theirs."""
    block, _ = fracture.blocks
    together = block >= 0
    share = np.ones(len(block))
    share[together] = 1.0 / np.bincount(block[together])[block[together]]
    return share


def _foremost(items: np.ndarray, by: np.ndarray, most: int, cost: np.ndarray | None = None) -> np.ndarray:
    """The items that are largest ``by`` something, at most so many, or of that cost together, in their order."""
    order = np.argsort(-by, kind="stable")
    spent = np.arange(1, len(items) + 1) if cost is None else np.cumsum(cost[order])
    return np.sort(items[order[: int(np.searchsorted(spent, most + 1e-6, side="right"))]])


class _Entries:
    """Nodes and weights while they are being collected."""

    def __init__(self) -> None:
        self.count = 0
        self.points: list[np.ndarray] = [np.zeros((0, 3))]
        self.elements: list[np.ndarray] = [np.zeros(0, np.int64)]
        none = (np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0))
        self.weights, self.around, self.centres = [none], [none], [none]
        self.foretold = [none], [none]
        self.several, self.askew = [none[0]], [none[0]]

    def add(self, points, element) -> np.ndarray:
        """Numbers of new nodes."""
        numbers = self.count + np.arange(len(points))
        self.count += len(points)
        self.points.append(points)
        self.elements.append(element)
        return numbers

    def own(self, element, points, weight) -> None:
        """Nodes that serve one element each."""
        entry = (element, self.add(points, element), weight)
        self.weights.append(entry)
        self.around.append(entry)

    def shared(self, element, fracture: Fracture) -> None:
        """Nodes that serve several elements each, which lie beside each other and face alike."""
        corners, points = fracture.elements[element], fracture.elements[element].mean(axis=1)
        normals = polygons.newell_normal(corners)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        behind = fracture.element_side[element] >= len(fracture.faces)
        normals = np.where(behind[:, None], -normals, normals)
        group, middle = clustered(points, normals, fracture.element_surface[element], _SHARED)
        numbers = self.add(points[middle], element[middle])
        entry = (element, numbers[group], np.ones(len(element)))
        self.weights.append(entry)
        self.around.append(entry)
        self.several.append(numbers)

    def nodes(self, element_sheet) -> Nodes:
        """All that was entered."""
        count = len(element_sheet)
        weights, around, centres = (_joined(entries, count) for entries in (self.weights, self.around, self.centres))
        on_lattices = 1 + max(int(entries[-1][0].max(initial=-1)) for entries in self.foretold)
        foretold = [_joined(entries, on_lattices) for entries in self.foretold]
        points, elements = np.concatenate(self.points), np.concatenate(self.elements)
        askew = np.zeros(count, bool)
        askew[np.concatenate(self.askew)] = True
        shared = np.concatenate(self.several)
        return Nodes(points, elements, element_sheet, weights, around, centres, foretold, shared, askew)


def _joined(entries: list, count: int) -> Weights:
    element, node, weight = (np.concatenate(part) for part in zip(*entries, strict=True))
    return Weights.of(element, node, weight, count)


def _enter(lattice: Layout, entries: _Entries) -> None:
    """Add the lattice's nodes, and the weights of all elements that are not cut."""
    grid = lattice.grid
    stretches = [
        [(a, n, a + lines_along(n, widest, spacing)) for a, n in along]
        for along, widest, spacing in zip(lattice.stretches, lattice.widest, grid.spacing, strict=True)
    ]
    lines = [np.concatenate([part[2] for part in along]) for along in stretches]
    rows, columns = np.meshgrid(*lines, indexing="ij")
    cell = (np.floor(rows).astype(int) * grid.columns + np.floor(columns).astype(int)).ravel()
    points = grid.corner + rows.ravel()[:, None] * grid.along_rows + columns.ravel()[:, None] * grid.along_columns
    numbers = entries.add(points, grid.first + 2 * cell).reshape(rows.shape)
    _foretell(stretches, numbers, entries)
    whole = np.flatnonzero(~lattice.cut.ravel())
    widest = max(float(np.diff(part[2]).max(initial=0.0)) for along in stretches for part in along)
    beside = grid.first + 2 * lattice.beside_askew(2 * widest)
    entries.askew.append(np.concatenate([beside, beside + 1]))

    def enter(half: int, centre, places, shares, order: int, out: list) -> None:
        row, column = np.divmod(whole, grid.columns)
        line_a, weight_a = stencils(stretches[0], np.arange(grid.rows), centre[0], places[:, 0], order)
        line_b, weight_b = stencils(stretches[1], np.arange(grid.columns), centre[1], places[:, 1], order)
        node = numbers[line_a[row][:, :, None], line_b[column][:, None, :]]
        weight_a *= shares[:, None, None]
        weight = np.matmul(weight_a.transpose(1, 2, 0)[:, None], weight_b.transpose(1, 0, 2)[None])[row, column]
        element = np.broadcast_to((grid.first + 2 * whole + half)[:, None, None], node.shape)
        out.append((element.ravel(), node.ravel(), weight.ravel()))

    for half, corners in enumerate(np.array(grid.corners, float)):
        centre = np.mean(corners, axis=0)
        enter(half, centre, polygons.RADON_PLACES @ corners, polygons.RADON_SHARES, 4, entries.weights)
        enter(half, centre, centre[None], np.ones(1), 2, entries.around)
    if max(grid.spacing) > 1:
        middle = np.array([0.5, 0.5])
        enter(0, middle, middle[None], np.ones(1), 4, entries.centres)


def _foretell(stretches, numbers: np.ndarray, entries: _Entries) -> None:
    """What each node of a lattice would have by its neighbours along either axis."""
    for axis, out in enumerate(entries.foretold):
        first = 0
        for _, _, lines in stretches[axis]:
            mine = np.moveaxis(np.take(numbers, np.arange(first, first + len(lines)), axis=axis), axis, 0)
            others, weights = left_out(lines)
            one, other, share = np.broadcast_arrays(mine[:, :, None], mine[others].swapaxes(1, 2), weights[:, None])
            out.append((one.ravel(), other.ravel(), share.ravel()))
            first += len(lines)
