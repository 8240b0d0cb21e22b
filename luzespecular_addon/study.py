"""One run from Blender to Blender: collect the scene and its light, solve, write the results.

`collect` and `finish` touch Blender and belong to the main thread; `Study.run` touches NumPy only and may run in any.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace

import bpy
from bpy.app.translations import pgettext_iface as iface_
from bpy.app.translations import pgettext_rpt as rpt_

from .. import core as luz
from ..core.terminal import clock
from . import display, export, light, scene_check, session, work_planes, writeback
from .choices import SKY_ITEMS
from .materials import as_typed
from .notices import Notice, refuse, stop_on_errors
from .translations import CONTEXT, solver_message

Progress = Callable[[float, str], bool]

_SHARE_OF_PREPARATION = 0.9

_FACES = {"DRAFT": 2_500, "FINE": 40_000}
"""Faces to aim at, where the solver's own choice (some 10,000) is not wanted."""

_BANDS = {"DRAFT": 30, "NORMAL": 60, "FINE": 90}


@dataclass(frozen=True)
class Study:
    """Everything that a run needs, free of Blender.

    Attributes
    ----------
    export : export.Export
    daylight : luz.Daylight
    options : dict
        Keyword arguments of `luz.prepare`.
    solving : dict
        Keyword arguments of `luz.Transfer.solve`.
    title : str
        Date, hour and sky, for people.
    scene_name, layer_name : str
        Scene and view layer that the run is about.
    notices : tuple of Notice
        Warnings and notes so far.
    grids : tuple of work_planes.Grid
        Points in mid-air to read as well.
    """

    export: export.Export
    daylight: luz.Daylight
    options: dict
    solving: dict
    title: str
    scene_name: str
    layer_name: str
    notices: tuple[Notice, ...]
    grids: tuple[work_planes.Grid, ...] = ()

    @property
    def key(self) -> Hashable:
        """What a prepared transfer has to agree in, to serve for this study."""
        return self.export.fingerprint, tuple(sorted(self.options.items()))

    def read(self, result: luz.Result, progress: Progress) -> list[work_planes.Reading]:
        """Compute the light on the work planes; raises `luz.Cancelled` when `progress` says so."""
        return work_planes.read(result, self.grids, _part(progress, 1.0, 1.0))

    def run(self, kept: session.Session, progress: Progress) -> luz.Result:
        """Solve, with the kept transfer if it fits; raises `luz.Cancelled` when `progress` says so."""
        transfer = kept.get(self.key)
        share = 0.0
        if transfer is None:
            share = _SHARE_OF_PREPARATION
            transfer = luz.prepare(self.export.scene, progress=_part(progress, 0.0, share), **self.options)
            kept.keep(self.key, transfer)
        return transfer.solve(self.daylight, progress=_part(progress, share, 1.0), **self.solving)


def collect(context: bpy.types.Context, exported: export.Export | None = None) -> Study:
    """Read scene, light and options, and check them; nothing is changed.

    Parameters
    ----------
    context : bpy.types.Context
    exported : export.Export, optional
        The scene, where it is known already and only the light is another.

    Raises
    ------
    BadInput
        Where something stands in the way, with all problems named.
    """
    scene, accuracy = context.scene, context.scene.luzespecular.accuracy
    daylight, remarks = light.daylight(scene)
    stop_on_errors(writeback.refusals(scene.objects))
    exported = exported or export.export_scene(context)
    _refuse_darkness(scene, daylight, exported)
    return Study(
        exported,
        daylight,
        _preparing(accuracy, exported.area),
        _solving(accuracy),
        title(scene),
        scene.name,
        context.view_layer.name,
        (*remarks, *exported.notices),
        _grids(scene.name, exported),
    )


def relit(study: Study, scene: bpy.types.Scene) -> Study:
    """Return a study with the light that a scene's settings describe now, geometry and all else as it was.

    Raises
    ------
    BadInput
        Where the settings describe no light that can be computed.
    """
    daylight, remarks = light.daylight(scene)
    _refuse_darkness(scene, daylight, study.export)
    return replace(
        study,
        daylight=daylight,
        title=title(scene),
        notices=(*remarks, *study.export.notices),
        grids=_grids(study.scene_name, study.export),
    )


def _grids(scene_name: str, exported: export.Export) -> tuple[work_planes.Grid, ...]:
    return tuple(work_planes.grids(bpy.data.scenes[scene_name], exported.unit_scale))


def _refuse_darkness(scene: bpy.types.Scene, daylight: luz.Daylight, exported: export.Export) -> None:
    if daylight.sky is None and daylight.sun is None and not exported.luminous:
        text = rpt_(
            "There is no light at {hour}: the Sun is down or off, there is no sky, no surface is luminous. "
            "Set hour or sky"
        )
        raise refuse(text.format(hour=clock(scene.luzespecular.site.hour)))


def finish(
    context: bpy.types.Context, study: Study, result: luz.Result, readings: Sequence[work_planes.Reading] = ()
) -> tuple[Notice, ...]:
    """Write the results of a run, and what was read on its work planes, to the scene and show them.

    Returns
    -------
    tuple of Notice
        What the user should know about the study, and about what the solver found in the scene.

    Raises
    ------
    BadInput
        Where the scene changed meanwhile; nothing is written then.
    """
    scene = bpy.data.scenes.get(study.scene_name)
    if scene is None or not is_current(context, study):
        raise refuse(rpt_("The scene changed while it was solved, so the results were thrown away: solve again"))
    notices = show(scene, study, result, readings)
    display.stand_for(scene, {surface.object_name for surface in study.export.surfaces if surface.receiver})
    display.apply_view(scene)
    return notices


def show(
    scene: bpy.types.Scene, study: Study, result: luz.Result, readings: Sequence[work_planes.Reading] | None
) -> tuple[Notice, ...]:
    """Write results to meshes and tables and colour them, whatever the viewports show; see `finish`."""
    notices = (*study.notices, *_remarks_of_solver(result))
    results = scene.luzespecular.results
    results.title = study.title
    results.notices.clear()
    for notice in notices:
        entry = results.notices.add()
        entry.level, entry.text = notice.level, notice.text
    display.write(scene, study.export, result, readings)
    return notices


def is_current(context: bpy.types.Context, study: Study) -> bool:
    """Whether the scene that a study is about still stands as it did when it was collected."""
    scene = bpy.data.scenes.get(study.scene_name)
    layer = scene and scene.view_layers.get(study.layer_name)
    if layer is None:
        return False
    with context.temp_override(scene=scene, view_layer=layer):
        return export.current_fingerprint(bpy.context) == study.export.fingerprint


def found(study: Study, result: luz.Result) -> list[scene_check.Found]:
    """Return what is odd in the scene that was solved, for the list of the scene check."""
    told = scene_check.of_notices(study.export.notices)
    return told + scene_check.of_solver(study.export, result.transfer.findings)


def _remarks_of_solver(result: luz.Result) -> list[Notice]:
    return [Notice("WARNING", solver_message(str(finding))) for finding in result.transfer.findings]


def _part(progress: Progress, begin: float, end: float) -> Progress:
    """Return a progress that fills the part of the whole from `begin` to `end`."""
    return lambda fraction, stage: progress(begin + (end - begin) * fraction, stage)


def title(scene: bpy.types.Scene) -> str:
    """Return date, hour and sky of a scene's settings in one line."""
    settings = scene.luzespecular
    site, sky = settings.site, settings.sky
    kind = iface_(next(name for key, name, _ in SKY_ITEMS if key == sky.kind), CONTEXT)
    if sky.kind == "CIE":
        kind = f"{kind} {sky.cie_type}"
    time = iface_("solar time") if site.time_kind == "SOLAR" else iface_("clock time")
    return f"{light.date_of(site).isoformat()}, {clock(site.hour)} {time}, {kind}"


def _preparing(accuracy: bpy.types.PropertyGroup, area: float) -> dict:
    """Return the keyword arguments of `luz.prepare`; ``area`` of all that scatters light [m²]."""
    fineness = accuracy.fineness
    if fineness == "EXPERT":
        return {
            "bands": accuracy.bands,
            "max_area": as_typed(accuracy.max_area) or None,
            "specular_cutoff": as_typed(accuracy.specular_cutoff),
            "threads": accuracy.threads or None,
        }
    if fineness == "ERROR":
        return {"accuracy": as_typed(accuracy.error) / 100.0}
    max_area = area / _FACES[fineness] if fineness in _FACES and area > 0.0 else None
    return {"bands": _BANDS[fineness], "max_area": max_area}


def _solving(accuracy: bpy.types.PropertyGroup) -> dict:
    """Return the keyword arguments of `luz.Transfer.solve`."""
    if accuracy.fineness != "EXPERT":
        return {}
    return {
        "tolerance": as_typed(accuracy.tolerance),
        "cycles": None if accuracy.cycles < 0 else accuracy.cycles,
    }
