"""Transfer: everything that geometry and materials decide, found once and used for any sky and Sun."""

from __future__ import annotations

import logging
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from .daylight import Daylight
from .errors import SceneError, TransferFileError
from .estimate import Trial, make_trial
from .fineness import TRIAL_BANDS, TRIAL_TIMES, bands_for, times_for
from .fingerprint import Fingerprint
from .flaws import Finding
from .form_factors import Conservation, Exchange, gather_nodes, patch_means
from .geometry import Geometry, make_geometry
from .globe import Globe
from .inspection import inspect, refuse
from .nodes import Nodes
from .options import Options, checked_memory, checked_scene, checked_threads
from .planes import find_planes
from .scene import Scene
from .sky import UniformSky
from .specular import ChainLimits, exact_mirrors
from .stages import Progress, Recorder, Stage

logger = logging.getLogger(__name__)

_LOOKING = "visibility and form factors"


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
    fingerprint : Fingerprint
        What scene and options it holds for.
    stages : tuple of Stage
    findings : tuple of Finding
        What the scene check warns of.
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
    fingerprint: Fingerprint
    stages: tuple[Stage, ...] = field(default=())
    findings: tuple[Finding, ...] = field(default=())

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

    def with_materials(self, scene: Scene) -> Transfer:
        """The same form factors with other diffuse reflectances and exitances: nothing is looked at again.

        Parameters
        ----------
        scene : Scene
            The same surfaces in the same order; what mirrors, transmits, reflects diffusely or shines must be the
            same, and by what share they mirror and transmit.

        Returns
        -------
        Transfer
            As `prepare` would give it. With ``accuracy``, fineness stays as it was chosen for the former materials.

        Raises
        ------
        SceneError
            Where anything else differs; the message says what.
        """
        options = Options(**self.fingerprint.options)
        difference = self.fingerprint.difference(Fingerprint.of(checked_scene(scene), options))
        if difference:
            raise SceneError(f"This transfer was prepared for {difference}; prepare the scene anew")
        geometry = self.geometry.with_materials(scene)
        note = Stage(_LOOKING, 0.0, "shapes, mirrors and panes are those of an earlier transfer")
        return replace(
            self,
            geometry=geometry,
            conservation=replace(self.conservation, kept=geometry.areas_kept),
            stages=(*(stage for stage in self.stages if stage.skipped and stage.name != _LOOKING), note),
            findings=inspect(scene, geometry.planes),
        )

    def save(self, path) -> Path:
        """Write the transfer to a file, for `load` or ``prepare(scene, cache=path)``.

        Parameters
        ----------
        path : str or path
            Written aside and renamed: the file is complete or not there.

        Returns
        -------
        Path

        Raises
        ------
        OSError
            Where it cannot be written.
        """
        from .store import save_transfer

        return save_transfer(self, path)


def prepare(
    scene: Scene,
    *,
    bands: int = 60,
    max_area: float | None = None,
    specular_cutoff: float = 1e-3,
    threads: int | None = None,
    memory: float | None = None,
    accuracy: float | None = None,
    reuse: Transfer | None = None,
    cache: str | Path | None = None,
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
    reuse : Transfer, optional
        An earlier one, whose form factors are kept where they hold (see `Transfer.with_materials`); where they do not,
        the scene is prepared anew, and ``stages`` say why.
    cache : path, optional
        A file as by `Transfer.save`, used in the same way; where it does not hold it is written anew.
    progress : callable(fraction, stage_name) -> bool, optional
        True to go on, False to cancel.

    Returns
    -------
    Transfer

    Raises
    ------
    SceneError
        Where the scene is empty or an option is out of range; the message names it and the remedy.
    OSError
        Where the cache cannot be read.
    Cancelled
        Where ``progress`` says so.
    """
    checked_scene(scene)
    options = Options.checked(bands=bands, max_area=max_area, specular_cutoff=specular_cutoff, accuracy=accuracy)
    threads, memory, cache = checked_threads(threads), checked_memory(memory), _checked_cache(cache)
    recorder = Recorder(progress)
    kept = _kept(scene, options, threads, reuse, cache, recorder)
    if kept is not None:
        recorder.report(1.0, "prepared")
        return kept
    common = (options, threads, memory)
    if options.accuracy is None:
        transfer = _prepared(scene, options.bands, 1.0, *common, recorder)
    else:
        times = times_for(options.accuracy)
        with recorder.stage("trial solution", 0.0):
            trial = _prepared(scene, TRIAL_BANDS, min(times, TRIAL_TIMES), *common, Recorder(recorder.part(0.0, 0.2)))
            errors, areas = trial.errors_by_globe(), trial.geometry.fracture.element_areas
            bands = bands_for(options.accuracy, TRIAL_BANDS, errors, areas)
        transfer = _prepared(scene, bands, times, *common, Recorder(recorder.part(0.2, 1.0), recorder.stages))
    return transfer if cache is None else _cached(transfer, cache)


def load(path, scene: Scene, *, threads: int | None = None) -> Transfer:
    """Load a transfer that `Transfer.save` wrote.

    Parameters
    ----------
    path : str or path
    scene : Scene
        That which it was prepared for; diffuse reflectances and exitances may have changed.
    threads : int, optional
        Default: as many as the machine has cores.

    Returns
    -------
    Transfer
        With the options that it was prepared with.

    Raises
    ------
    TransferFileError
        Where the file is stale, damaged, or no transfer; the message names it and the remedy.
    OSError
        Where it cannot be read.
    """
    from .store import load_transfer

    return load_transfer(path, checked_scene(scene), None, checked_threads(threads))


def _kept(scene: Scene, options: Options, threads: int, reuse, cache: Path | None, recorder: Recorder):
    """An earlier transfer, or one from a file, if it holds for the scene; else None, with the reason in the stages."""
    if reuse is not None:
        if not isinstance(reuse, Transfer):
            raise SceneError(f"reuse must be a luzespecular.Transfer, not {type(reuse).__name__}")
        difference = reuse.fingerprint.difference(Fingerprint.of(scene, options))
        if not difference:
            return replace(reuse.with_materials(scene), threads=threads)
        recorder.skip("reuse", f"the transfer was prepared for {difference}")
    if cache is not None:
        from .store import load_transfer

        if not cache.exists():
            recorder.skip("cache", f"'{cache}' is not there yet")
            return None
        try:
            with recorder.stage("cache", 0.0):
                kept = load_transfer(cache, scene, options, threads)
        except TransferFileError as error:
            recorder.skip("cache", str(error))
            return None
        note = Stage(_LOOKING, 0.0, f"taken from '{cache}'")
        return replace(kept, stages=(*recorder.stages, note))
    return None


def _cached(transfer: Transfer, cache: Path) -> Transfer:
    """The transfer, saved; a disk that is full is no reason to lose it."""
    recorder = Recorder(stages=list(transfer.stages))
    try:
        with recorder.stage("cache", 1.0):
            transfer.save(cache)
    except OSError as error:
        logger.warning("The transfer was not saved: %s", error)
        recorder.skip("cache", f"not saved: {error}")
    return replace(transfer, stages=tuple(recorder.stages))


def _checked_cache(cache) -> Path | None:
    if cache is None:
        return None
    try:
        path = Path(cache)
    except TypeError:
        raise SceneError(f"cache must be the path of a file, not {cache!r}") from None
    if path.is_dir() or not path.absolute().parent.is_dir():
        raise SceneError(f"cache '{path}' must be a file in a folder that exists")
    return path


def _prepared(
    scene: Scene,
    bands: int,
    times: float,
    options: Options,
    threads: int,
    memory: float | None,
    recorder: Recorder,
) -> Transfer:
    """See `prepare`: all that follows once the fineness is known."""
    globe = Globe.cut_at_horizon(bands)  # a parcel is sky or ground, never both
    with recorder.stage("planes", 0.0):
        planes = find_planes(scene)
    with recorder.stage("scene check", 0.005):
        findings = inspect(scene, planes)
        refuse(findings)
    with recorder.stage("fracture", 0.01):
        geometry = make_geometry(scene, planes, globe, options.max_area, times)
    limits = ChainLimits(options.specular_cutoff, exact_mirrors(geometry.outlines))
    _check_memory(geometry, memory)
    with recorder.stage(_LOOKING, 0.02):
        lattice, nodes, gathered, unsure = gather_nodes(
            geometry, limits, times, threads, lambda done: recorder.report(0.02 + 0.97 * done, _LOOKING)
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
        fingerprint=Fingerprint.of(scene, options),
        stages=tuple(recorder.stages),
        findings=findings,
    )


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
