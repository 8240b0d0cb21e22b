"""Enclosures: parts of a scene that hardly exchange light with each other, such as rooms without a door between."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .arrays import dots
from .geometry import Geometry
from .nodes import Nodes
from .rays import RayScene

APART = 1e-3
"""Share of its light that a part exchanges with all others at most."""

_ROWS = 256

_TRIED = 20_000
"""Straight ways between two parts that are tried before it is believed that none is open."""

_MOST_PAIRS = 40
"""Where more parts than this seem to see each other, they are left as they are."""

_SEALED = 1 - 1e-6
"""Share of a way at which whatever is met is its end."""

_INSIDE = 0.01
"""How far inside triangles ways end, that no wall which stands on their border counts as their end."""


@dataclass(frozen=True, eq=False)
class Enclosures:
    """Which part of the scene each patch, node and element belongs to.

    Attributes
    ----------
    count : int
    of_patches : (p,) int
    of_nodes : (m,) int
    of_elements : (e,) int
    """

    count: int
    of_patches: np.ndarray
    of_nodes: np.ndarray
    of_elements: np.ndarray

    @classmethod
    def of(cls, factors: np.ndarray, areas: np.ndarray, form_factors: np.ndarray, first: np.ndarray) -> Enclosures:
        """Find them.

        Parameters
        ----------
        factors : (p, p) float32
            Form factors from patch to patch.
        areas : (p,) float
            Of the patches [m²].
        form_factors : (m, p) float32
            From nodes to patches.
        first : (e,) int
            A node of each element.
        """
        of_patches = enclosed(factors, areas)
        count = int(of_patches.max(initial=0)) + 1
        of_nodes = np.zeros(len(form_factors), np.int64)
        if count > 1:
            member = np.zeros((len(of_patches), count), np.float32)
            member[np.arange(len(of_patches)), of_patches] = 1.0
            for start in range(0, len(form_factors), _ROWS):
                some = slice(start, start + _ROWS)
                of_nodes[some] = np.argmax(np.abs(form_factors[some]) @ member, axis=1)
        return cls(count, of_patches, of_nodes, of_nodes[first])

    def sums(self, of: np.ndarray, values: np.ndarray) -> np.ndarray:
        """(count,) float: sums of values over each part."""
        return np.bincount(of, weights=values, minlength=self.count)


def enclosed(factors: np.ndarray, areas: np.ndarray) -> np.ndarray:
    """(p,) int: numbers of the parts that patches belong to.

    From single patches on, each part that exchanges more than `APART` of its light with others joins the one that it
    exchanges most with. What exchanges nothing with anything is of part 0.

    Parameters
    ----------
    factors : (p, p) float
        What each patch gives each other, over its area. The diagonal is another one for a while.
    areas : (p,) float
        Of the patches, in any measure.
    """
    of = np.arange(len(factors))
    used = np.ones(len(factors), bool)
    areas = areas.astype(factors.dtype)
    while len(factors) > 1:
        diagonal = factors.diagonal().copy()
        own, got = areas * diagonal, areas @ factors
        sent = areas * (factors @ np.ones(len(factors), factors.dtype))
        if len(of) == len(factors):
            used = (sent > 0) | (got > 0)
        np.fill_diagonal(factors, -1.0)
        partner = factors.argmax(axis=1)
        blind = np.flatnonzero(sent <= own)
        partner[blind] = (areas[:, None] * factors[:, blind]).argmax(axis=0)
        np.fill_diagonal(factors, diagonal)
        closed = sent + got - 2 * own <= APART * (sent + got)
        joined = _joined(np.where(closed, np.arange(len(factors)), partner))
        if int(joined.max()) + 1 == len(factors):
            break
        of, factors = joined[of], _contracted(factors, areas, joined)
        areas = np.ones(len(factors), factors.dtype)
    numbers = np.zeros(len(of), np.int64)
    numbers[used] = np.unique(of[used], return_inverse=True)[1].reshape(-1)
    return numbers


def _contracted(factors: np.ndarray, areas: np.ndarray, joined: np.ndarray) -> np.ndarray:
    """What parts give each other, of what their members do."""
    order = np.argsort(joined, kind="stable")
    starts = np.flatnonzero(np.diff(joined[order], prepend=-1))
    rows = np.stack([areas[some] @ factors[some] for some in np.split(order, starts[1:])])
    return np.add.reduceat(rows[:, order], starts, axis=1)


def _joined(partner: np.ndarray) -> np.ndarray:
    """(n,) int: numbers from 0 on, the same for whatever is joined to its partner, directly or by others."""
    number = np.arange(len(partner))
    while True:
        before = number
        number = np.minimum(number, number[partner])
        np.minimum.at(number, partner, number.copy())
        number = number[number]
        if (number == before).all():
            return np.unique(number, return_inverse=True)[1].reshape(-1)


def keep_apart(geometry: Geometry, nodes: Nodes, parts: Enclosures, form_factors: np.ndarray) -> bool:
    """Take out, in place, what parts seem to see of each other though no way between them is open.

    Where edges of several surfaces cross a beam, single nodes may see a thousandth past them. Within a closed room
    nothing is lost by that; from a bright one into a dark one it is light that is not there. A hole is found by the
    ways through it, and stays, unless what leaks is thousands of times more. Where there are mirrors, ways are not
    straight: all is left as it is.

    Parameters
    ----------
    geometry : Geometry
    nodes : Nodes
    parts : Enclosures
    form_factors : (m, p) float32
        From nodes to patches.

    Returns
    -------
    bool
        Whether there was anything to take out.
    """
    if parts.count < 2 or any(m.is_specular and not m.is_transparent for m in geometry.outlines.materials):
        return False
    sealed = _sealed(geometry, nodes, parts, form_factors)
    if sealed.any():
        _moved_home(form_factors, parts.of_nodes, parts.of_patches, sealed)
    return bool(sealed.any())


def _sealed(geometry: Geometry, nodes: Nodes, parts: Enclosures, form_factors: np.ndarray) -> np.ndarray:
    """(count, count) bool: parts whose nodes see something of others', and of which no straight way leads there."""
    seen: dict[tuple[int, int], list[tuple[np.ndarray, np.ndarray, np.ndarray]]] = {}
    for first in range(0, len(form_factors), _ROWS):
        some = form_factors[first : first + _ROWS]
        of = parts.of_nodes[first : first + _ROWS]
        row, patch = np.nonzero((of[:, None] != parts.of_patches) & (some > 0))
        for one, other in np.unique(np.stack([of[row], parts.of_patches[patch]], axis=1), axis=0).tolist():
            mine = (of[row] == one) & (parts.of_patches[patch] == other)
            seen.setdefault((one, other), []).append((first + row[mine], patch[mine], some[row[mine], patch[mine]]))
    chance = np.random.default_rng(0)
    rays = _opaque(geometry)
    tried_in_vain, open_ = np.zeros((2, parts.count, parts.count), bool)
    for pair, found in seen.items() if len(seen) <= _MOST_PAIRS else ():
        node, patch, weight = (np.concatenate(part) for part in zip(*found, strict=True))
        tried = chance.choice(len(node), _TRIED, p=weight / weight.sum(dtype=float))
        open_[pair] = _open(geometry, nodes, rays, node[tried], patch[tried], chance).any()
        tried_in_vain[pair] = not open_[pair]
    return tried_in_vain & ~open_.T


def _opaque(geometry: Geometry) -> RayScene:
    """What straight ways end at: all outlines but panes."""
    outlines = geometry.outlines
    opaque = np.array([not m.is_transparent for m in outlines.materials])
    return RayScene(outlines.vertices[opaque], outlines.normals[opaque], outlines.offsets[opaque], outlines.tolerance)


def _open(geometry: Geometry, nodes: Nodes, rays: RayScene, node, patch, chance) -> np.ndarray:
    """(k,) bool: whether ways from nodes lead ahead to random places on patches' lit sides, and meet nothing before."""
    of = geometry.targets.patches.of_element
    order = np.argsort(of, kind="stable")
    start, end = np.searchsorted(of[order], [patch, patch + 1])
    element = order[start + (chance.random(len(patch)) * (end - start)).astype(int)]
    share = _INSIDE / 3 + (1 - _INSIDE) * chance.dirichlet([1.0, 1.0, 1.0], len(patch))
    way = np.einsum("kv,kvc->kc", share, geometry.fracture.elements[element]) - nodes.points[node]
    _, distance = rays.nearest(nodes.points[node], way)
    ahead = dots(way, geometry.element_normals[nodes.element[node]]) > 0
    return (distance >= _SEALED) & ahead & (dots(way, geometry.element_normals[element]) < 0)


def _moved_home(factors: np.ndarray, of_rows: np.ndarray, of_patches: np.ndarray, sealed: np.ndarray) -> None:
    """Let rows see of their own part what they seemed to see of parts that are sealed off, in place."""
    for first in range(0, len(factors), _ROWS):
        some, of = factors[first : first + _ROWS], of_rows[first : first + _ROWS]
        away = sealed[of][:, of_patches]
        own = np.where(of[:, None] == of_patches, some, 0.0)
        total, moved = own.sum(axis=1), np.where(away, some, 0.0).sum(axis=1)
        more = np.divide(moved, total, out=np.zeros(len(total)), where=total > 0)
        some += own * more[:, None].astype(some.dtype)
        some[away & (total > 0)[:, None]] = 0.0
