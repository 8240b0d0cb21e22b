"""Transfer: everything that geometry and materials decide, found once and used for any sky and Sun."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from .daylight import Daylight
from .errors import SceneError
from .estimate import Trial, make_trial
from .fineness import TRIAL_BANDS, TRIAL_TIMES, bands_for, times_for
from .form_factors import Conservation, Exchange, gather_nodes, patch_means
from .geometry import Geometry, make_geometry
from .globe import Globe
from .nodes import Nodes
from .planes import find_planes
from .scene import Scene
from .sky import UniformSky
from .specular import ChainLimits, exact_mirrors
from .stages import Progress, Recorder, Stage


@dataclass(frozen=True, eq=False)
class Transfer:
    """A scene's transfer of light; see `prepare`. Use `solve` for any number of lights.

    Attributes
    ----------
    geometry : Geometry
    nodes : Nodes
        The receivers, and how elements' values follow from theirs.
    lattice : Nodes
        The first of them alone, before any were added where interpolation is in doubt.
    unsure : (e,) float
        What interpolation between nodes leaves open, over all light.
    conservation : Conservation
    times : float
        How many times finer than usual the scene is resolved.
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
    exchange : Exchange
        From patch to patch.
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
    exchange: Exchange
    unlit: np.ndarray
    truncated: np.ndarray
    nodes: Nodes
    lattice: Nodes
    unsure: np.ndarray
    conservation: Conservation
    times: float
    limits: ChainLimits
    threads: int
    stages: tuple[Stage, ...] = field(default=())

    @property
    def patch_factors(self) -> np.ndarray:
        """(p, p) float: form factors from patch to patch, area-weighted means over each."""
        return self.exchange.factors

    @cached_property
    def trial(self) -> Trial:
        """A coarser look from some of the nodes, for those who ask for errors; found when first asked for."""
        return make_trial(self.geometry, self.nodes, self.limits, self.threads)

    def on_elements(self, values: np.ndarray) -> np.ndarray:
        """Values on the elements ``(e,)`` from values at the nodes ``(m,)``."""
        return self.nodes.on_elements(values)

    def errors_by_globe(self) -> np.ndarray:
        """(e,) float: relative errors that the globe's fineness causes, as estimated under an even sky."""
        from .solve import globe_errors

        light = Daylight(sky=UniformSky(1000.0))
        result = self.solve(light, tolerance=1e-2)
        return globe_errors(self, light, result.sky, result.field)

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
    accuracy: float | None = None,
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
    accuracy : float, optional
        Relative error that about 95 of 100 faces shall keep below, 0.001 to 0.2 (see `Result.error`). Bands, receivers,
        patches and, where ``max_area`` is not given, faces are then chosen for it from a trial solution; ``bands`` has
        no meaning.
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
    accuracy = _checked_accuracy(accuracy)
    Globe(bands)  # refused before any work
    recorder = Recorder(progress)
    common = (max_area, specular_cutoff, threads, memory)
    if accuracy is None:
        return _prepared(scene, bands, 1.0, *common, recorder)
    times = times_for(accuracy)
    with recorder.stage("trial solution", 0.0):
        trial = _prepared(scene, TRIAL_BANDS, min(times, TRIAL_TIMES), *common, Recorder(recorder.part(0.0, 0.2)))
        bands = bands_for(accuracy, TRIAL_BANDS, trial.errors_by_globe(), trial.geometry.fracture.element_areas)
    return _prepared(scene, bands, times, *common, Recorder(recorder.part(0.2, 1.0), recorder.stages))


def _prepared(
    scene: Scene,
    bands: int,
    times: float,
    max_area: float | None,
    specular_cutoff: float,
    threads: int,
    memory: float | None,
    recorder: Recorder,
) -> Transfer:
    """See `prepare`: all that follows once the fineness is known."""
    globe = Globe.cut_at_horizon(bands)  # a parcel is sky or ground, never both
    with recorder.stage("planes", 0.0):
        planes = find_planes(scene)
    with recorder.stage("fracture", 0.01):
        geometry = make_geometry(scene, planes, globe, max_area, times)
    limits = ChainLimits(specular_cutoff, exact_mirrors(geometry.outlines))
    _check_memory(geometry, memory)
    stage = "visibility and form factors"
    with recorder.stage(stage, 0.02):
        lattice, nodes, gathered, unsure = gather_nodes(
            geometry, limits, times, threads, lambda done: recorder.report(0.02 + 0.97 * done, stage)
        )
        conservation = Conservation.of(geometry, nodes, gathered)
        patch_factors = patch_means(geometry, nodes, gathered.form_factors)
        spread = patch_means(geometry, nodes, conservation.spread[:, None])[:, 0]
        exchange = Exchange(patch_factors, spread, conservation.missing)
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
        deep_factors=np.stack([gathered.deep[row] for row in deep_rows.tolist()])
        if len(deep_rows)
        else np.zeros((0, geometry.targets.patches.count), np.float32),
        deep_rows=deep_rows,
        exchange=exchange,
        unlit=gathered.unlit,
        truncated=gathered.truncated,
        nodes=nodes,
        lattice=lattice,
        unsure=unsure,
        conservation=conservation,
        times=times,
        limits=limits,
        threads=threads,
        stages=tuple(recorder.stages),
    )


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


def _checked_accuracy(accuracy) -> float | None:
    if accuracy is None:
        return None
    number = _positive("accuracy", accuracy)
    if not 1e-3 <= number <= 0.2:
        raise SceneError(f"accuracy is {number:g}; give a relative error from 0.001 to 0.2 (0.01 is usual)")
    return number


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
