"""Form factors of a scene: rows for all nodes, more of these where interpolation between them is in doubt."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from .arrays import product
from .convex import ConvexRoom
from .enclosures import Enclosures
from .gather import Gathered, gather
from .geometry import Geometry, sight_of
from .nodes import Nodes, settled
from .parallel import chunks_of_receivers, run_parallel
from .scattered import scattered_sight
from .sparse import SparseRows
from .specular import GroupSight
from .tracing import ChainLimits

_CHUNK_CELLS = 200_000
"""Receivers times beams looked at together: they stay in cache, and matrix products are too small for BLAS to split."""

_MOST_SIGHTS = 100
"""Planes whose view is kept for other receivers of theirs; of facets of meshes there are too many."""

_ROOM = 1.5
"""Room for rows, over those known to be needed."""

_UNHIDDEN_ROWS = 200
"""Receivers of one plane that are looked from together where nothing stands in the way."""

_FOR_ONE_THREAD = 200
"""Fewer receivers are looked from in one thread: several would wait for each other."""

_SCATTERED = 64
"""Receivers of many facets each that are looked from together."""

_DARK = 1e-9
"""Mean form factor to the sky below which none is seen."""

_GROUPS = 32
_ROWS = 256
_CYCLES, _REFLECTANCE = 4, 0.5
"""Reflections after which surfaces are about as bright as they will be, and of how much, whatever they reflect now."""

_DARKEST = 1e-6
"""No surface counts as less bright than this share of their mean."""

_OF_REFLECTED = 0.2
"""About how bright surfaces are beside the sky that they show with."""


_DENSE = ("form_factors", "unlit", "truncated")
"""What `Rows` holds as whole arrays."""


@dataclass(frozen=True, eq=False)
class Rows:
    """Form factors of nodes, as in `Transfer`; ``deep`` holds, for few or none, what comes by way of many mirrors."""

    form_factors: np.ndarray
    sky_direct: SparseRows
    sky_specular: SparseRows
    unlit: np.ndarray
    truncated: np.ndarray
    deep: dict[int, np.ndarray]

    @classmethod
    def empty(cls, count: int, geometry: Geometry) -> Rows:
        """Room for rows, which costs no memory until they are entered."""
        targets = geometry.targets
        return cls(
            np.empty((count, targets.patches.count), np.float32),
            SparseRows((count, targets.columns)),
            SparseRows((count, targets.columns)),
            np.zeros(count, np.float32),
            np.zeros(count, np.float32),
            {},
        )

    def first(self, count: int) -> Rows:
        """The first so many rows, beyond which none were entered."""
        dense = {name: getattr(self, name)[:count] for name in _DENSE}
        return replace(self, **dense, sky_direct=self.sky_direct.of(count), sky_specular=self.sky_specular.of(count))

    def kept(self, used: int, count: int, geometry: Geometry) -> Rows:
        """Room for more rows, after the first ``used`` of these."""
        wide = Rows.empty(count, geometry)
        for name in _DENSE:
            getattr(wide, name)[:used] = getattr(self, name)[:used]
        sky = {name: getattr(self, name).of(count) for name in ("sky_direct", "sky_specular")}
        return replace(wide, **sky, deep=self.deep)

    def put(self, members: np.ndarray, rows: Gathered) -> None:
        """Enter the rows of some nodes."""
        self.form_factors[members] = rows.patches
        self.sky_direct.enter(members, rows.sky_direct)
        self.unlit[members] = rows.unlit
        self.truncated[members] = rows.truncated
        if rows.sky_specular is not None:
            self.sky_specular.enter(members, rows.sky_specular)
        if rows.deep is not None:
            lit = np.flatnonzero(rows.deep.any(axis=1))
            self.deep.update(zip(members[lit].tolist(), rows.deep[lit], strict=True))


def gather_nodes(
    geometry: Geometry,
    lattice: Nodes,
    limits: ChainLimits,
    times: float,
    threads: int,
    report: Callable[[float], None],
    allow: Callable[[int], None] = lambda rows: None,
    convex: ConvexRoom | None = None,
    keep: Callable[[Nodes, np.ndarray, Rows], np.ndarray] = lambda nodes, members, rows: members,
) -> tuple[Nodes, Rows, np.ndarray]:
    """Form factors of all nodes.

    Parameters
    ----------
    geometry : Geometry
    lattice : Nodes
        Those that every scene begins with.
    limits : ChainLimits
    times : float
        How many times finer than usual.
    threads : int
    report : callable(fraction)
    allow : callable(rows)
        Called before room is taken for so many nodes; may raise where that is too much.
    convex : ConvexRoom, optional
        Where nothing stands in the way.
    keep : callable(nodes, members, rows) -> (k,) int
        Enters rows of some nodes that are known, and tells which are not.

    Returns
    -------
    nodes : Nodes
        All.
    rows : Rows
    unsure : (e,) float
        See `Nodes.unsure`.
    """
    allow(int(_ROOM * len(lattice.points)))
    room = Rows.empty(int(_ROOM * len(lattice.points)), geometry)
    sights: dict[int, GroupSight] = {}
    light = Light.none()
    done = 0.0

    def evaluate(nodes: Nodes, first: int) -> np.ndarray:
        nonlocal room, light, done
        count = len(nodes.points)
        if count > len(room.unlit):
            allow(int(_ROOM * count))
            room = room.kept(first, int(_ROOM * count), geometry)
        members = np.arange(first, count)
        begun, share = done, (1.0 - done) * (0.6 if first == 0 else 0.7)

        def partly(part: float) -> None:
            report(begun + share * part)

        if convex is None:
            _gather_some(geometry, nodes, keep(nodes, members, room), room, sights, limits, threads, partly)
        else:
            _gather_unhidden(geometry, nodes, members, room, convex, threads, partly)
        done = begun + share
        light = light.followed(Light.of(geometry, room, first, count))
        return light.kinds()

    nodes = settled(lattice, geometry.fracture, evaluate, times)
    report(1.0)
    return nodes, room.first(len(nodes.points)), nodes.unsure(light.kinds(), geometry.fracture)


def _gather_some(geometry: Geometry, nodes: Nodes, members, rows: Rows, sights, limits, threads: int, report) -> None:
    """Fill the rows of some nodes."""
    # so many that receivers times beams stay in cache
    most = max(8, _CHUNK_CELLS // max(geometry.beams.count // 2, 1))
    sheets = nodes.sheet
    shared = members[np.isin(members, nodes.shared)]
    scattered = [shared[k : k + _SCATTERED] for k in range(0, len(shared), _SCATTERED)]
    members = np.setdiff1d(members, shared)
    chunks = [members[c] for c in chunks_of_receivers(nodes.points[members], sheets[members], geometry.planes, most)]

    def from_facets(chunk: np.ndarray, checkpoint) -> None:
        sight = scattered_sight(geometry, limits, nodes.weights.turned(chunk))
        rows.put(chunk, gather(sight, nodes.points[chunk], geometry.targets, checkpoint))

    def from_one_plane(chunk: np.ndarray, checkpoint) -> None:
        sheet = int(sheets[chunk[0]])
        sight = sights.get(sheet)
        if sight is None:
            normal = geometry.element_normals[nodes.element[chunk[0]]]
            sight = sight_of(geometry, limits, normal, float(normal @ nodes.points[chunk[0]]), geometry.beams)
            if len(sights) < _MOST_SIGHTS:
                sights[sheet] = sight
        rows.put(chunk, gather(sight, nodes.points[chunk], geometry.targets, checkpoint))

    tasks = [(from_one_plane, chunk) for chunk in chunks] + [(from_facets, chunk) for chunk in scattered]
    few = len(members) + len(shared) < _FOR_ONE_THREAD
    run_parallel(lambda task, checkpoint: task[0](task[1], checkpoint), tasks, 1 if few else threads, report)


def _gather_unhidden(
    geometry: Geometry, nodes: Nodes, members, rows: Rows, convex: ConvexRoom, threads, report
) -> None:
    """The same where nothing stands in the way."""

    def work(chunk: np.ndarray, checkpoint) -> None:
        checkpoint()
        factors = convex.factors(nodes.points[chunk], geometry.element_normals[nodes.element[chunk[0]]])
        rows.form_factors[chunk] = factors[:, :-1]

    chunks = chunks_of_receivers(nodes.points[members], nodes.sheet[members], geometry.planes, _UNHIDDEN_ROWS)
    run_parallel(work, [members[chunk] for chunk in chunks], threads, report)


def _brightness(geometry: Geometry, nodes: Nodes, sky: np.ndarray, form_factors: np.ndarray) -> np.ndarray:
    """(p,) float: exitance of the patches below an even sky, about, over the sky's; all alike where none is seen.

    ``sky`` (m,) and ``form_factors`` (m, p) of the nodes, to all of the sky and to patches.
    """
    areas = geometry.fracture.element_areas
    if float(geometry.patch_sums(areas * nodes.on_elements(sky)).sum()) <= _DARK * float(geometry.patch_areas.sum()):
        return np.ones(geometry.targets.patches.count)
    exitance = np.zeros(geometry.targets.patches.count, np.float32)
    for _ in range(_CYCLES):
        illuminance = nodes.on_elements(sky + form_factors @ exitance)
        exitance = (_REFLECTANCE * geometry.patch_means(illuminance)).astype(np.float32)
    return exitance + _DARKEST * exitance.mean()


@dataclass(frozen=True, eq=False)
class Light:
    """What nodes get from four sides of the sky ``(m, 4)`` and from groups of surfaces ``(m, g)``, both float."""

    sky: np.ndarray
    reflected: np.ndarray

    @classmethod
    def none(cls) -> Light:
        """That of no nodes."""
        return cls(np.zeros((0, 4)), np.zeros((0, _GROUPS)))

    @classmethod
    def of(cls, geometry: Geometry, rows: Rows, first: int, count: int) -> Light:
        """That of the nodes from ``first`` on, ``count`` in all, all sky and all surfaces being equally bright.

        The sides of the sky blend into each other: between sharp ones light would seem to change from node to node
        where it does not. Nothing here is left to BLAS, whose threads would stay awake and in the way of those that
        look from the next nodes.
        """
        targets, planes = geometry.targets, geometry.planes
        east, north = targets.globe.directions[: targets.sky_parcels, :2].T
        sides = np.zeros((targets.columns, 4), np.float32)
        sides[:-1] = 0.25 * (1 + np.stack([east, -east, north, -north], axis=1))
        sides[-1] = 0.25
        sheet = targets.patches.sheets(geometry.fracture.element_sheet)
        group = sheet * _GROUPS // (2 * len(planes.sheet_surface))
        order = np.argsort(group, kind="stable") if (np.diff(group) < 0).any() else slice(None)
        begin = np.flatnonzero(np.diff(group[order], prepend=-1))
        reflected = np.zeros((count - first, _GROUPS))
        for row in range(first, count if len(sheet) else first, _ROWS):
            some = rows.form_factors[row : min(row + _ROWS, count)][:, order]
            reflected[row - first :][: len(some), group[order][begin]] = np.add.reduceat(some, begin, axis=1)
        sky = rows.sky_direct.sums_of_rows(sides, first) + rows.sky_specular.sums_of_rows(sides, first)
        return cls(sky[: count - first], reflected)

    def followed(self, other: Light) -> Light:
        """That of these nodes and of others after them."""
        return Light(np.concatenate([self.sky, other.sky]), np.concatenate([self.reflected, other.reflected]))

    def kinds(self) -> np.ndarray:
        """(m, 4 + g) float: all kinds of light, surfaces about as bright as they will be; groups that give none not."""
        share = _OF_REFLECTED if self.sky.sum() > 1e-3 * max(float(self.reflected.sum()), 1e-300) else 1.0
        return np.concatenate([self.sky, share * self.reflected[:, self.reflected.any(axis=0)]], axis=1)


def patch_means(geometry: Geometry, nodes: Nodes, form_factors: np.ndarray) -> np.ndarray:
    """(p, k): means of the elements' form factors, from the nodes' ``(m, k)``, over each patch; as precise as these."""
    patch, area = geometry.targets.patches.of_element, geometry.fracture.element_areas
    count = geometry.targets.patches.count
    means = np.zeros((count, form_factors.shape[1]), form_factors.dtype)
    if not count:
        return means
    element = nodes.weights.rows
    mine = patch[element] >= 0
    share = nodes.weights.weight[mine] * area[element[mine]]
    key = patch[element[mine]] * len(nodes.points) + nodes.weights.node[mine]
    pairs, place = np.unique(key, return_inverse=True)
    weight = np.bincount(place.reshape(-1), weights=share, minlength=len(pairs))
    to, node = np.divmod(pairs, len(nodes.points))
    weight = weight / geometry.patch_areas[to]
    bounds = np.searchsorted(to, np.arange(count + 1))
    step = max(1, int(4e6) // max(count, 1))
    first = 0
    while first < count:
        last = max(first + 1, int(np.searchsorted(bounds, bounds[first] + step, side="right")) - 1)
        mine = slice(bounds[first], bounds[last])
        used, column = np.unique(node[mine], return_inverse=True)
        shares = np.zeros((last - first, len(used)), np.float32)
        shares[to[mine] - first, column.reshape(-1)] = weight[mine]
        means[first:last] = shares @ form_factors[used]
        first = last
    return means


@dataclass(frozen=True, eq=False)
class Conservation:
    """How light that is sent out and seen to stay is made to arrive to the last lumen.

    Means over faces and patches err a little, mostly where planes meet, and so would the sum of what arrives. What is
    missing is spread over all receivers of the same enclosure, as surroundings below an even sky would light them, or
    without sky even ones: an even field stays as it is, and no light comes into a room that is closed off.

    Attributes
    ----------
    kept : (e,) float
        Area times the share of light that counts as landed: all but what mirrors and panes pass on [m²].
    lost : (e,) float
        Share of what an element sends out that escapes, falls on dark sides or is cut off.
    spread : (m,) float
        Illuminance of the nodes for one lumen more in their enclosure [1/m²].
    missing : (p,) float
        Lumens that are missing for one lm/m² of each patch's exitance [m²].
    beyond : (p,) float
        Lumens that escape beyond ``lost``, likewise: what is sent, seems to stay and is not believed to arrive [m²].
    enclosures : Enclosures
    """

    kept: np.ndarray
    lost: np.ndarray
    spread: np.ndarray
    missing: np.ndarray
    beyond: np.ndarray
    enclosures: Enclosures

    @classmethod
    def of(cls, geometry: Geometry, nodes: Nodes, rows: Rows, enclosures: Enclosures) -> Conservation:
        """Compare what patches send out with what nodes receive."""
        area = geometry.fracture.element_areas
        kept = geometry.areas_kept
        sky = rows.sky_direct.row_totals() + rows.sky_specular.row_totals()
        lost = nodes.weights.apply(sky + rows.unlit + rows.truncated)
        weights = nodes.weights
        share = weights.gathered(kept, len(nodes.points))
        landed, seen = np.zeros(geometry.targets.patches.count), np.zeros(len(share))
        brightness = _brightness(geometry, nodes, sky, rows.form_factors)
        for first in range(0, len(share), _ROWS):
            some = rows.form_factors[first : first + _ROWS].astype(float)
            landed += share[first : first + _ROWS] @ some
            seen[first : first + _ROWS] = some @ brightness
        sent = geometry.patch_sums(area * (1 - lost))
        for profile in geometry.targets.patches.profiles:
            profile.evened(sent, landed)
        trust = trusted(1 - sent / np.maximum(geometry.patch_areas, 1e-300))
        missing, beyond = (sent - landed) * trust, (sent - landed) * (1 - trust)
        total = enclosures.sums(enclosures.of_nodes, share * seen)[enclosures.of_nodes]
        return cls(kept, lost, np.divide(seen, total, out=seen, where=total > 0), missing, beyond, enclosures)

    def made_up(self, exitance: np.ndarray) -> np.ndarray:
        """(m,) or (m, c): illuminance of the nodes by what is missing of patches' exitance ``(p,)`` or ``(p, c)``."""
        parts = self.enclosures
        by_part = np.zeros((parts.count, *exitance.shape[1:]), exitance.dtype)
        for part in range(parts.count):
            by_part[part] = np.where(parts.of_patches == part, self.missing, 0.0).astype(exitance.dtype) @ exitance
        spread = self.spread.astype(exitance.dtype)
        return (spread if exitance.ndim == 1 else spread[:, None]) * by_part[parts.of_nodes]


def trusted(lost):
    """Weight of what is sent and stays against what arrives: both err by about the same share of what they measure.

    Where almost all escapes, the little that stays is known better from where it arrives.
    """
    stays = np.clip(1 - lost, 0, 1)
    return stays**2 / (stays**2 + (1 - stays) ** 2)


@dataclass(frozen=True, eq=False)
class Exchange:
    """Light from patch to patch: ``exchange @ exitance``.

    Attributes
    ----------
    factors : (p, p) float32
        Form factors from each patch (receiver) to each patch (emitter).
    spread, missing : (p,) float
        What evens out their errors: see `Conservation`.
    part : (p,) int
        Enclosure of each patch.
    exact : bool
        Multiply in float64: see `arrays.product`.
    """

    factors: np.ndarray
    spread: np.ndarray
    missing: np.ndarray
    part: np.ndarray
    exact: bool = False

    def __matmul__(self, exitance: np.ndarray) -> np.ndarray:
        by_part = np.bincount(self.part, weights=self.missing * exitance)
        return product(self.factors, exitance, self.exact) + (
            self.spread * by_part[self.part] if len(self.part) else 0.0
        )
