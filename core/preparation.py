"""Preparation: from a scene to its transfer, anew or as far as needed."""

from __future__ import annotations

import logging
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np

from .convex import ConvexRoom
from .enclosures import Enclosures, keep_apart
from .errors import SceneError, TransferFileError
from .fineness import TRIAL_BANDS, TRIAL_TIMES, bands_for, receiver_bands, times_for
from .fingerprint import Fingerprint
from .form_factors import Conservation, Exchange, Rows, gather_nodes, patch_means
from .geometry import Geometry, make_geometry
from .globe import Globe
from .inspection import inspect, refuse
from .nodes import Nodes
from .options import Options, checked_memory, checked_scene, checked_threads
from .planes import find_planes
from .scene import Scene
from .skips import needless
from .stages import Progress, Recorder, Stage
from .store import load_transfer
from .tracing import ChainLimits, exact_mirrors
from .transfer import LOOKING, Transfer
from .unaffected import Unaffected

logger = logging.getLogger(__name__)


def prepare(
    scene: Scene,
    *,
    bands: int = 60,
    max_area: float | None = None,
    specular_cutoff: float = 1e-3,
    threads: int | None = None,
    memory: float | None = None,
    accuracy: float | None = None,
    receivers: Iterable[str] | None = None,
    reuse: Transfer | None = None,
    cache: str | Path | None = None,
    progress: Progress | None = None,
) -> Transfer:
    """Find everything that geometry and materials decide.

    Parameters
    ----------
    scene : Scene
    bands : int
        Bands of the globe; 60 gives 5,902 parcels. An odd number is raised by one. Points look along its parcels; faces
        along beams of 0.4 times as many bands, but 24 at least, which tell their means about as well.
    max_area : float, optional
        Largest area of a face [m²]. None = chosen for the scene, some 10,000 faces; inf = faces as given, only
        triangulated. Purely specular and black surfaces are not cut for their size.
    specular_cutoff : float
        Specular chains are followed down to this product of reflectances.
    threads : int, optional
        Default: as many as the machine has cores.
    memory : float, optional
        Most bytes that the transfer may hold: a scene that needs more is refused before work, or where receivers are
        added once it turns out that light is uneven. Work itself takes some 100 MB for each thread besides.
    accuracy : float, optional
        Relative error that about 95 of 100 faces shall keep below, 0.001 to 0.2 (see `Result.error`). Bands, receivers,
        patches and, where ``max_area`` is not given, faces are then chosen for it from a trial solution; ``bands`` has
        no meaning.
    receivers : iterable of str, optional
        Surfaces whose faces are wanted; results know these alone. The others take part in the interreflection, cut no
        finer than it needs. Default: all.
    reuse : Transfer, optional
        An earlier one, whose form factors are kept where they hold: all where shapes, mirrors and panes are the same
        (see `Transfer.with_materials`); where surfaces were moved, added or taken away within the scene's bounding box,
        those of receivers that see nothing of these, before or now. ``stages`` say how many, or why none.
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
    scene = Scene(dict(checked_scene(scene).surfaces))  # as it stands: it may grow while this runs
    options = Options.checked(
        scene,
        bands=bands,
        max_area=max_area,
        specular_cutoff=specular_cutoff,
        accuracy=accuracy,
        receivers=receivers,
    )
    threads, memory, cache = checked_threads(threads), checked_memory(memory), _checked_cache(cache)
    recorder = Recorder(progress)
    kept = _kept(scene, options, threads, reuse, cache, recorder)
    if kept is not None:
        recorder.report(1.0, "prepared")
        return kept
    common = (options, threads, memory)
    if options.accuracy is None:
        transfer = _prepared(scene, options.bands, receiver_bands(options.bands), 1.0, *common, recorder, reuse)
    else:
        times = times_for(options.accuracy)
        with recorder.stage("trial solution", 0.0):
            least = min(times, TRIAL_TIMES)
            trial = _prepared(scene, TRIAL_BANDS, TRIAL_BANDS, least, *common, Recorder(recorder.part(0.0, 0.2)))
            errors, areas = trial.errors_by_globe(), trial.geometry.fracture.element_areas
            bands = bands_for(options.accuracy, TRIAL_BANDS, errors, areas)
        rest = Recorder(recorder.part(0.2, 1.0), recorder.stages)
        transfer = _prepared(scene, bands, bands, times, *common, rest, reuse)
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
    return load_transfer(path, checked_scene(scene), None, checked_threads(threads))


def _kept(scene: Scene, options: Options, threads: int, reuse, cache: Path | None, recorder: Recorder):
    """An earlier transfer, or one from a file, if it holds for the scene; else None, with the reason in the stages."""
    if reuse is not None:
        if not isinstance(reuse, Transfer):
            raise SceneError(f"reuse must be a luzespecular.Transfer, not {type(reuse).__name__}")
        fingerprint = Fingerprint.of(scene, options)
        if not reuse.fingerprint.difference(fingerprint):
            return replace(reuse.with_materials(scene), threads=threads)
    if cache is not None:
        if not cache.exists():
            recorder.skip("cache", f"'{cache}' is not there yet")
            return None
        try:
            with recorder.stage("cache", 0.0):
                kept = load_transfer(cache, scene, options, threads)
        except TransferFileError as error:
            recorder.skip("cache", str(error))
            return None
        if reuse is not None:
            recorder.skip("reuse", _difference(reuse, fingerprint))
        note = Stage(LOOKING, 0.0, f"taken from '{cache}'")
        return replace(kept, stages=(*recorder.stages, note))
    return None


def _difference(reuse: Transfer, fingerprint: Fingerprint) -> str:
    return f"the transfer was prepared for {reuse.fingerprint.difference(fingerprint)}"


def _unaffected(reuse: Transfer | None, geometry: Geometry, fingerprint: Fingerprint) -> tuple[Unaffected | None, str]:
    """What of an earlier transfer may hold for a scene of other shapes, None where nothing can; and in words."""
    kept = "keep their form factors"
    if reuse is None or reuse.fingerprint.options != fingerprint.options:
        return None, kept
    if fingerprint.options["accuracy"] is not None:
        return None, f"{kept}, as fineness is chosen anew for the accuracy"
    before, planes = reuse.geometry, geometry.planes
    # all coordinates are measured from the middle of the scene
    if planes.size != before.planes.size or not np.array_equal(planes.centre, before.planes.centre):
        return None, f"{kept}, as the scene's bounding box has changed"
    # which outlines are large depends on all of them
    if geometry.outlines.facets is not None or before.outlines.facets is not None:
        return None, f"{kept}, as there are more outlines than are projected"
    rows = Rows(reuse.form_factors, reuse.sky_direct, reuse.sky_specular, reuse.unlit, reuse.truncated, deep={})
    return Unaffected.of(geometry, before, reuse.nodes, rows, fingerprint.changed(reuse.fingerprint)), kept


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
    beams: int,
    times: float,
    options: Options,
    threads: int,
    memory: float | None,
    recorder: Recorder,
    reuse: Transfer | None = None,
) -> Transfer:
    """See `prepare`: all that follows once the fineness is known."""
    fingerprint = Fingerprint.of(scene, options)
    globe, wide = (Globe.cut_at_horizon(count) for count in (bands, beams))  # a parcel is sky or ground, never both
    with recorder.stage("planes", 0.0):
        planes = find_planes(scene)
    with recorder.stage("scene check", 0.005):
        findings = inspect(scene, planes)
        refuse(findings)
    with recorder.stage("fracture", 0.01):
        geometry = make_geometry(scene, planes, globe, options.max_area, times, options.receivers, wide)
    limits = ChainLimits(options.specular_cutoff, exact_mirrors(geometry.outlines))
    with recorder.stage(LOOKING, 0.02):
        lattice = Nodes.of(geometry.fracture, geometry.lattices)
        convex = ConvexRoom.of(geometry, lattice)
        unaffected, what = _unaffected(reuse, geometry, fingerprint)
        kept = 0

        def keep(nodes: Nodes, members: np.ndarray, rows: Rows) -> np.ndarray:
            nonlocal kept
            if unaffected is None:
                return members
            mine, earlier = unaffected.among(nodes, members)
            unaffected.enter(rows, mine, earlier)
            kept += len(mine)
            return np.setdiff1d(members, mine)

        nodes, gathered, unsure = gather_nodes(
            geometry,
            lattice,
            limits,
            times,
            threads,
            lambda done: recorder.report(0.02 + 0.97 * done, LOOKING),
            lambda nodes: _check_memory(geometry, nodes, memory),
            convex,
            keep,
        )
        patch_factors = patch_means(geometry, nodes, gathered.form_factors)
        first = nodes.weights.node[nodes.weights.start[:-1]]
        enclosures = Enclosures.of(patch_factors, geometry.patch_areas, gathered.form_factors, first)
        if keep_apart(geometry, nodes, enclosures, gathered.form_factors):
            patch_factors = patch_means(geometry, nodes, gathered.form_factors)
        conservation = Conservation.of(geometry, nodes, gathered, enclosures)
        spread = geometry.patch_means(nodes.weights.apply(conservation.spread))
        exchange = Exchange(
            patch_factors.astype(np.float32, copy=False), spread, conservation.missing, enclosures.of_patches
        )
    sees_out = gathered.sky_direct.any() or gathered.sky_specular.any()
    if reuse is not None:
        recorder.skip("reuse", f"{_difference(reuse, fingerprint)}; {kept} of {len(nodes.points)} receivers {what}")
    for name, why in needless(geometry, sees_out, convex is not None):
        recorder.skip(name, why)
    recorder.report(1.0, "prepared")
    deep_rows = np.array(sorted(gathered.deep), np.int64)
    return Transfer(
        geometry=geometry,
        form_factors=gathered.form_factors,
        sky_direct=gathered.sky_direct,
        sky_specular=gathered.sky_specular,
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
        unhidden=convex is not None,
        times=times,
        limits=limits,
        threads=threads,
        fingerprint=fingerprint,
        stages=tuple(recorder.stages),
        findings=findings,
    )


def bytes_held(geometry: Geometry, nodes: int) -> float:
    """What a transfer with so many nodes holds at most, about: every receiver may see all of the sky."""
    columns, patches = geometry.targets.columns, geometry.targets.patches.count
    specular = 2 if geometry.outlines.any_specular else 1
    return 4.0 * nodes * (patches + specular * columns) + 8.0 * patches**2


def _check_memory(geometry: Geometry, nodes: int, memory: float | None) -> None:
    needed = bytes_held(geometry, nodes)
    if memory is not None and needed > memory:
        raise SceneError(
            f"The scene needs {needed / 1e9:.2f} GB for {nodes} receivers, more than the {memory / 1e9:.2f} GB of "
            "'memory'; raise max_area, lower bands, or allow more memory"
        )
