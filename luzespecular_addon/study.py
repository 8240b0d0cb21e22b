"""One run from Blender to Blender: collect the scene and its light, solve, write the results.

`collect` and `finish` touch Blender and belong to the main thread; `Study.run` touches NumPy only and may run in any.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import bpy
from bpy.app.translations import pgettext_iface as iface_
from bpy.app.translations import pgettext_rpt as rpt_

from .. import core as luz
from ..core import tables
from ..core.terminal import clock
from . import display, export, light, results_object, session, writeback
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
    title : str
        Date, hour and sky, for people.
    notices : tuple of Notice
        Warnings and notes so far.
    """

    export: export.Export
    daylight: luz.Daylight
    options: dict
    title: str
    notices: tuple[Notice, ...]

    def run(self, kept: session.Session, progress: Progress) -> luz.Result:
        """Solve, with the kept transfer if it fits; raises `luz.Cancelled` when `progress` says so."""
        key = (self.export.fingerprint, tuple(sorted(self.options.items())))
        transfer = kept.get(key)
        share = 0.0
        if transfer is None:
            share = _SHARE_OF_PREPARATION
            transfer = luz.prepare(self.export.scene, progress=_part(progress, 0.0, share), **self.options)
            kept.keep(key, transfer)
        return transfer.solve(self.daylight, progress=_part(progress, share, 1.0))


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
    scene = context.scene
    daylight, remarks = light.daylight(scene)
    stop_on_errors(writeback.refusals(scene.objects))
    exported = exported or export.export_scene(context)
    if daylight.sky is None and daylight.sun is None and not exported.luminous:
        text = rpt_(
            "There is no light at {hour}: the Sun is down or off, there is no sky, no surface is luminous. "
            "Set hour or sky"
        )
        raise refuse(text.format(hour=clock(scene.luzespecular.site.hour)))
    return Study(
        exported,
        daylight,
        _options(scene.luzespecular.accuracy, exported.area),
        title(scene),
        (*remarks, *exported.notices),
    )


def finish(context: bpy.types.Context, study: Study, result: luz.Result) -> tuple[Notice, ...]:
    """Write the results of a run to the scene and show them.

    Returns
    -------
    tuple of Notice
        What the user should know about the study, and about what the solver found in the scene.

    Raises
    ------
    BadInput
        Where the scene changed meanwhile; nothing is written then.
    """
    scene = context.scene
    if export.current_fingerprint(context) != study.export.fingerprint:
        raise refuse(rpt_("The scene changed while it was solved, so the results were thrown away: solve again"))
    own = writeback.own_results(study.export, result)
    results_object.create(scene, study.export, result)
    for results in own:
        writeback.write(results)
    notices = (*study.notices, *_remarks_of_solver(study, result))
    _fill_table(scene, study, result, notices)
    display.show(scene)
    return notices


def _remarks_of_solver(study: Study, result: luz.Result) -> list[Notice]:
    texts = [solver_message(note) for note in result.notes]
    for surface in study.export.scene.surfaces.values():
        for note in surface.notes:
            texts.append(rpt_("Surface '{name}': {remark}").format(name=surface.name, remark=solver_message(note)))
    return [Notice("WARNING", text) for text in texts]


def _part(progress: Progress, begin: float, end: float) -> Progress:
    """Return a progress that fills the part of the whole from `begin` to `end`."""
    return lambda fraction, stage: progress(begin + (end - begin) * fraction, stage)


def title(scene: bpy.types.Scene) -> str:
    """Return date, hour and sky of a scene's settings in one line."""
    settings = scene.luzespecular
    site, sky = settings.site, settings.sky
    kind = next(name for key, name, _ in SKY_ITEMS if key == sky.kind)
    time = iface_("solar time") if site.time_kind == "SOLAR" else iface_("clock time")
    return f"{light.date_of(site).isoformat()}, {clock(site.hour)} {time}, {iface_(kind, CONTEXT)}"


def _options(accuracy: bpy.types.PropertyGroup, area: float) -> dict:
    fineness = accuracy.fineness
    if fineness == "EXPERT":
        return {"bands": accuracy.bands, "max_area": as_typed(accuracy.max_area) or None}
    max_area = area / _FACES[fineness] if fineness in _FACES and area > 0.0 else None
    return {"bands": _BANDS[fineness], "max_area": max_area}


def _fill_table(scene: bpy.types.Scene, study: Study, result: luz.Result, notices: tuple[Notice, ...]) -> None:
    results = scene.luzespecular.results
    results.title = study.title
    results.rows.clear()
    receivers = {surface.name: surface for surface in study.export.surfaces if surface.receiver}
    for statistics in tables.surface_statistics(result, receivers):
        row = results.rows.add()
        row.name, row.object_name = statistics.name, receivers[statistics.name].object_name
        row.side = statistics.side
        row.area, row.minimum, row.mean = statistics.area, statistics.minimum, statistics.mean
        row.maximum, row.uniformity = statistics.maximum, statistics.uniformity
    results.notices.clear()
    for notice in notices:
        entry = results.notices.add()
        entry.level, entry.text = notice.level, notice.text
