"""Transfer: everything that geometry and materials decide, found once and used for any sky and Sun."""

from __future__ import annotations

import itertools
import math
import os
import threading
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from dataclasses import dataclass, field

import numpy as np

from .errors import Cancelled, SceneError
from .fracture import Fracture, fracture, make_patches
from .gather import Gathered, Targets, gather
from .globe import Globe
from .nodes import Nodes
from .planes import Planes, find_planes
from .scene import Scene
from .specular import ChainLimits, GroupSight, Outlines, exact_mirrors
from .stages import Progress, Recorder, Stage

PATCHES = 2_000
"""Patches that exitance is resolved in."""

_POLL = 0.1
"""Seconds between looks whether the user wants to stop."""

_CHUNK_CELLS = 250_000
"""Receivers times beams looked at together: they stay in cache, and matrix products are too small for BLAS to split."""


@dataclass(frozen=True, eq=False)
class Geometry:
    """A scene made ready: planes, faces, what beams can end on.

    Attributes
    ----------
    planes : Planes
    fracture : Fracture
    targets : Targets
    outlines : Outlines
    surface_materials : list of Material, one per surface
    element_normals : (e, 3) float
    element_points : (e, 3) float, relative to the scene's centre
    """

    planes: Planes
    fracture: Fracture
    targets: Targets
    outlines: Outlines
    surface_materials: list
    element_normals: np.ndarray
    element_points: np.ndarray

    @property
    def element_surface(self) -> np.ndarray:
        """(e,) int."""
        return self.planes.sheet_surface[self.fracture.element_sheet % len(self.planes.sheet_surface)]


@dataclass(frozen=True, eq=False)
class Transfer:
    """A scene's transfer of light; see `prepare`. Use `solve` for any number of lights.

    Attributes
    ----------
    geometry : Geometry
    nodes : Nodes
        The receivers, and ``steps``, how elements' values follow from theirs (see `Nodes.steps`).
    form_factors : (m, p) float32
        From each node (receiver) to each patch.
    sky_direct : (m, c) float32
        From each node to each sky parcel, and last to the ground; through panes, without mirrors.
    sky_specular : (k, c) float32
        The same by way of mirrors, for the nodes in ``specular_rows``.
    specular_rows : (k,) int
    deep_factors : (j, p) float32
        The part of ``form_factors`` that comes by more mirrors than bright polygons are followed through, for the nodes
        in ``deep_rows``.
    deep_rows : (j,) int
    patch_factors : (p, p) float
        From patch to patch: area-weighted means over each patch's nodes.
    unlit, truncated : (m,) float32
        Form factors to sides without diffuse light, and of chains cut off.
    limits : ChainLimits
    threads : int
    stages : tuple of Stage
    """

    geometry: Geometry
    form_factors: np.ndarray
    sky_direct: np.ndarray
    sky_specular: np.ndarray
    specular_rows: np.ndarray
    deep_factors: np.ndarray
    deep_rows: np.ndarray
    patch_factors: np.ndarray
    unlit: np.ndarray
    truncated: np.ndarray
    nodes: Nodes
    steps: list
    limits: ChainLimits
    threads: int
    stages: tuple[Stage, ...] = field(default=())

    def on_elements(self, values: np.ndarray) -> np.ndarray:
        """Values on the elements ``(e,)`` from values at the nodes ``(m,)``."""
        out = np.zeros(len(self.geometry.element_points))
        self.nodes.spread(values, self.steps, out)
        return out

    def solve(self, light, *, tolerance: float = 1e-4, cycles: int | None = None, progress: Progress | None = None):
        """Illuminance for one sky and Sun.

        Parameters
        ----------
        light : Daylight
        tolerance : float
            Stop when the change left to come is below this share of the mean illuminance.
        cycles : int, optional
            Exactly this many diffuse reflections instead; 0 = none.
        progress : callable(fraction, stage_name) -> bool, optional
            True to go on, False to cancel.

        Returns
        -------
        Result

        Raises
        ------
        SceneError
            Where an option is out of range, or light multiplies without end (closed scene of reflectance 1).
        Cancelled
            Where ``progress`` says so.
        """
        from .solve import solve_light

        return solve_light(self, light, tolerance=tolerance, cycles=cycles, progress=progress)


def prepare(
    scene: Scene,
    *,
    bands: int = 60,
    max_area: float | None = None,
    specular_cutoff: float = 1e-3,
    threads: int | None = None,
    memory: float | None = None,
    progress: Progress | None = None,
) -> Transfer:
    """Find everything that geometry and materials decide.

    Parameters
    ----------
    scene : Scene
    bands : int
        Bands of the globe; 60 gives 5,902 parcels. An odd number is raised by one.
    max_area : float, optional
        Largest area of a face [m²]. None = chosen for the scene, some 10,000 faces; inf = faces as given, only
        triangulated. Purely specular and black surfaces are not cut for their size.
    specular_cutoff : float
        Specular chains are followed down to this product of reflectances.
    threads : int, optional
        Default: as many as the machine has cores.
    memory : float, optional
        Most bytes that the transfer may hold.
    progress : callable(fraction, stage_name) -> bool, optional
        True to go on, False to cancel.

    Returns
    -------
    Transfer

    Raises
    ------
    SceneError
        Where the scene is empty or an option is out of range; the message names it and the remedy.
    Cancelled
        Where ``progress`` says so.
    """
    max_area, specular_cutoff, threads, memory = _checked_options(scene, max_area, specular_cutoff, threads, memory)
    globe = Globe.cut_at_horizon(bands)  # a parcel is sky or ground, never both
    recorder = Recorder(progress)
    with recorder.stage("planes", 0.0):
        planes = find_planes(scene)
    with recorder.stage("fracture", 0.01):
        geometry = make_geometry(scene, planes, globe, max_area)
    _check_memory(geometry, memory)
    with recorder.stage("visibility and form factors", 0.02):
        limits = ChainLimits(specular_cutoff, exact_mirrors(geometry.outlines))
        gathered, patch_factors, nodes, steps = _gather_elements(geometry, limits, threads, recorder)
    if not geometry.outlines.any_specular:
        recorder.skip("specular chains", "no surface mirrors or transmits regularly")
    recorder.report(1.0, "prepared")
    specular_rows = np.flatnonzero(gathered.specular_rows)
    deep_rows = np.array(sorted(gathered.deep), np.int64)
    return Transfer(
        geometry=geometry,
        form_factors=gathered.form_factors,
        sky_direct=gathered.sky_direct,
        sky_specular=gathered.sky_specular[specular_rows]
        if len(specular_rows)
        else np.zeros((0, geometry.targets.columns), np.float32),
        specular_rows=specular_rows,
        deep_factors=np.array([gathered.deep[row] for row in deep_rows], np.float32).reshape(len(deep_rows), -1),
        deep_rows=deep_rows,
        patch_factors=patch_factors,
        unlit=gathered.unlit,
        truncated=gathered.truncated,
        nodes=nodes,
        steps=steps,
        limits=limits,
        threads=threads,
        stages=tuple(recorder.stages),
    )


def make_geometry(scene: Scene, planes: Planes, globe: Globe, max_area: float | None) -> Geometry:
    """Cut planes into faces, elements and patches, and list the outlines with their materials."""
    surfaces = list(scene.surfaces.values())
    reflects = np.array([s.material.diffuse_reflectance > 0 for s in surfaces])
    emits = np.array([s.material.exitance > 0 for s in surfaces])
    # light that a black luminous surface receives goes nowhere: cut it only where the user says how fine
    cut = reflects | (emits & (max_area is not None))
    two_sided = np.array([s.two_sided for s in surfaces])
    cuts = fracture(planes, cut, reflects, two_sided, max_area)
    points = cuts.elements.mean(axis=1)
    fronts = len(planes.sheet_surface)
    surface = planes.sheet_surface[cuts.element_sheet % fronts]
    normals = (
        planes.sheet_normal[cuts.element_sheet % fronts] * np.where(cuts.element_sheet >= fronts, -1.0, 1.0)[:, None]
    )
    active = (reflects | emits)[surface]
    patches = make_patches(planes, cuts.elements, cuts.element_sheet, active, cuts.element_areas, PATCHES)
    outline_surface = planes.sheet_surface[planes.outline_sheet]
    outline_normals = planes.sheet_normal[planes.outline_sheet]
    outlines = Outlines(
        vertices=planes.outlines,
        normals=outline_normals,
        offsets=np.einsum("oc,oc->o", outline_normals, planes.outlines[:, 0]),
        materials=[surfaces[k].material for k in outline_surface],
        two_sided=two_sided[outline_surface],
        tolerance=max(1e-9 * planes.size, 8 * float(np.finfo(float).eps) * float(np.abs(planes.centre).max())),
    )
    return Geometry(
        planes, cuts, Targets.of(planes, patches, globe), outlines, [s.material for s in surfaces], normals, points
    )


def chunks_of_receivers(points, sheet, planes: Planes, most: int) -> list[np.ndarray]:
    """Receivers of one plane that lie near each other, in chunks.

    Parameters
    ----------
    points : (m, 3) float
    sheet : (m,) int, plus the number of sheets for backs
    planes : Planes
    most : int
        Receivers in a chunk.

    Returns
    -------
    list of (k,) int arrays
    """
    fronts = len(planes.sheet_surface)
    order = np.argsort(sheet, kind="stable")
    bounds = np.flatnonzero(np.concatenate(([True], np.diff(sheet[order]) > 0, [True])))
    chunks = []
    for a, b in itertools.pairwise(bounds):
        members = order[a:b]
        if len(members) > most:
            place = points[members] @ planes.sheet_axes[sheet[members[0]] % fronts].T
            extent = np.maximum(np.ptp(place, axis=0), 1e-300)
            blocks = len(members) / most
            cell = math.sqrt(extent.prod() / blocks) if extent.min() > 1e-9 * extent.max() else extent.max() / blocks
            block = np.floor((place - place.min(axis=0)) / cell)
            members = members[np.lexsort((place[:, 1], block[:, 1], block[:, 0]))]
        chunks += [members[k : k + most] for k in range(0, len(members), most)]
    return chunks


def sight_of(geometry: Geometry, limits: ChainLimits, normal, offset: float) -> GroupSight:
    """What receivers with this normal, in the plane ``normal · x = offset``, can see."""
    return GroupSight(geometry.outlines, geometry.targets.globe.hemisphere(normal), offset, limits)


@dataclass(frozen=True, eq=False)
class _Rows:
    form_factors: np.ndarray
    sky_direct: np.ndarray
    sky_specular: np.ndarray
    specular_rows: np.ndarray
    unlit: np.ndarray
    truncated: np.ndarray
    deep: dict[int, np.ndarray]

    @classmethod
    def empty(cls, count: int, geometry: Geometry) -> _Rows:
        targets = geometry.targets
        specular = (count, targets.columns) if geometry.outlines.any_specular else (0, targets.columns)
        return cls(
            np.empty((count, targets.patches.count), np.float32),
            np.empty((count, targets.columns), np.float32),
            np.zeros(specular, np.float32),
            np.zeros(count, bool),
            np.zeros(count, np.float32),
            np.zeros(count, np.float32),
            {},
        )

    def put(self, members: np.ndarray, rows: Gathered) -> None:
        self.form_factors[members] = rows.patches
        self.sky_direct[members] = rows.sky_direct
        self.unlit[members] = rows.unlit
        self.truncated[members] = rows.truncated
        if rows.sky_specular is not None:
            self.sky_specular[members] = rows.sky_specular
            self.specular_rows[members] = True
        if rows.deep is not None:
            lit = np.flatnonzero(rows.deep.any(axis=1))
            self.deep.update(zip(members[lit].tolist(), rows.deep[lit], strict=True))


def _gather_elements(geometry: Geometry, limits: ChainLimits, threads: int, recorder: Recorder):
    nodes = Nodes.of(geometry.fracture)
    rows = _Rows.empty(len(nodes.points), geometry)
    # so many that receivers times beams stay in cache
    most = max(8, _CHUNK_CELLS // max(geometry.targets.globe.count // 2, 1))
    chunks = chunks_of_receivers(nodes.points, nodes.sheet, geometry.planes, most)
    sights: dict[int, GroupSight] = {}
    for members in chunks:
        sheet = int(nodes.sheet[members[0]])
        if sheet not in sights:
            normal = geometry.element_normals[nodes.element[members[0]]]
            sights[sheet] = sight_of(geometry, limits, normal, float(normal @ nodes.points[members[0]]))

    def work(members: np.ndarray, checkpoint) -> None:
        sight = sights[int(nodes.sheet[members[0]])]
        rows.put(members, gather(sight, nodes.points[members], geometry.targets, checkpoint))

    def report(done: float) -> None:
        recorder.report(0.02 + 0.94 * done, "visibility and form factors")

    run_parallel(work, chunks, threads, report)
    steps = nodes.steps(rows.form_factors if rows.form_factors.shape[1] else rows.sky_direct)
    return rows, _patch_means(geometry, nodes, rows.form_factors), nodes, steps


def run_parallel(work: Callable, tasks: list, threads: int, report: Callable[[float], None]) -> None:
    """Run ``work(task, checkpoint)`` for each task on several threads.

    ``report`` is called with the share of tasks done, and often enough for a user to stop a long one. Where it raises,
    tasks under way stop at their next checkpoint and the exception goes on to the caller.
    """
    stop = threading.Event()

    def checkpoint() -> None:
        if stop.is_set():
            raise Cancelled("Cancelled")

    with ThreadPoolExecutor(max_workers=threads) as pool:
        pending = {pool.submit(work, task, checkpoint) for task in tasks}
        try:
            done = 0
            while pending:
                finished, pending = wait(pending, timeout=_POLL, return_when=FIRST_COMPLETED)
                for future in finished:
                    future.result()
                done += len(finished)
                report(done / len(tasks))
        except BaseException:
            stop.set()
            for future in pending:
                future.cancel()
            raise


def _patch_means(geometry: Geometry, nodes: Nodes, form_factors: np.ndarray) -> np.ndarray:
    """(p, p) float: means of the nodes' form factors over each patch."""
    patch = geometry.targets.patches.of_element[nodes.element]
    area = geometry.fracture.element_areas[nodes.element]
    count = geometry.targets.patches.count
    means = np.zeros((count, count))
    mine = np.flatnonzero(patch >= 0)
    order = mine[np.argsort(patch[mine], kind="stable")]
    if not len(order):
        return means
    starts = np.flatnonzero(np.concatenate(([True], np.diff(patch[order]) > 0)))
    step = max(1, int(2e7) // max(count, 1))
    bounds = np.append(starts, len(order))
    first = 0
    while first < count:
        last = int(np.searchsorted(bounds, bounds[first] + step, side="right")) - 1
        last = min(max(last, first + 1), count)
        rows = order[bounds[first] : bounds[last]]
        weighted = form_factors[rows] * area[rows, None]
        means[first:last] = np.add.reduceat(weighted, starts[first:last] - bounds[first], axis=0)
        first = last
    return means / np.bincount(patch[mine], weights=area[mine], minlength=count)[:, None]


def _checked_options(scene, max_area, specular_cutoff, threads, memory):
    if not isinstance(scene, Scene):
        raise SceneError(f"prepare needs a luzespecular.Scene, not {type(scene).__name__}")
    if not scene.surfaces:
        raise SceneError("The scene has no surfaces; add at least one with scene.add(name, vertices, material)")
    if max_area is not None:
        max_area = _positive("max_area", max_area, infinite=True)
    cutoff = _positive("specular_cutoff", specular_cutoff)
    if cutoff > 1:
        raise SceneError(f"specular_cutoff is {cutoff:g}; give a product of reflectances of at most 1 (1e-3 is usual)")
    if threads is None:
        threads = os.cpu_count() or 1
    elif isinstance(threads, bool) or not isinstance(threads, int | np.integer) or threads < 1:
        raise SceneError(f"threads must be a whole number of at least 1, not {threads!r}")
    if memory is not None:
        memory = _positive("memory", memory, infinite=True)
    return max_area, cutoff, int(threads), memory


def _positive(name: str, value, infinite: bool = False) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise SceneError(f"{name} must be a number, not {value!r}") from None
    if not number > 0 or (math.isinf(number) and not infinite):
        raise SceneError(f"{name} must be above 0, not {number:g}")
    return number


def _check_memory(geometry: Geometry, memory: float | None) -> None:
    elements, columns = len(geometry.element_points), geometry.targets.columns
    patches = geometry.targets.patches.count
    specular = 2 if geometry.outlines.any_specular else 1
    needed = 4.0 * elements * (patches + specular * columns) + 8.0 * patches**2
    if memory is not None and needed > memory:
        raise SceneError(
            f"The scene needs {needed / 1e9:.2f} GB for {elements} receivers, more than the {memory / 1e9:.2f} GB "
            "of 'memory'; raise max_area, lower bands, or allow more memory"
        )
