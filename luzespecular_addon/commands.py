"""Without a window: ``blender --background scene.blend --command luzespecular solve --hours 9,12 --out folder``.

The same through Blender's Python module: ``python luzespecular_addon scene.blend solve --hours 9,12 --out folder``, or
`main` with the file already open. Exit status: 0 solved, 1 refused or failed with a message that says why, 2 a wrong
argument, 130 interrupted. The .blend that was opened is never written to.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

import bpy
from bpy.app.translations import pgettext_rpt as rpt_

from .. import core as luz
from ..core import files, tables, terminal
from . import job, light, notices, pictures, session, study, work_planes
from .translations import solver_message

FORMATS = ("csv", "json", "png", "blend")
"""What the command can write."""

# Options that set one number each: option, settings group, property, explanation.
_NUMBERS = (
    ("--latitude", "site", "latitude", "degrees, north positive"),
    ("--longitude", "site", "longitude", "degrees, east positive"),
    ("--time-zone", "site", "time_zone", "hours that clocks are ahead of UTC"),
    ("--north", "site", "north_offset", "angle in degrees from +Y to true north, clockwise"),
    (
        "--sky-illuminance",
        "sky",
        "horizontal_illuminance",
        "lx by the sky on an open horizontal plane",
    ),
    ("--sun-illuminance", "sky", "sun_illuminance", "lx by the Sun on a plane that faces it"),
    ("--ground", "sky", "ground_reflectance", "reflectance of the ground around the scene"),
    ("--error", "accuracy", "error", "per cent that 95 of 100 faces shall keep below (sets --fineness error)"),
    ("--bands", "accuracy", "bands", "bands of the globe (sets --fineness expert)"),
    ("--max-area", "accuracy", "max_area", "largest face in m² (sets --fineness expert)"),
)


_handles: list[object] = []


def register() -> None:
    """Make the command known to Blender."""
    _handles.append(bpy.utils.register_cli_command("luzespecular", main))


def unregister() -> None:
    """Take the command away."""
    while _handles:
        bpy.utils.unregister_cli_command(_handles.pop())


def main(arguments: Sequence[str]) -> int:
    """Run the command on the open file.

    Parameters
    ----------
    arguments : sequence of str
        What follows ``luzespecular`` on the command line.

    Returns
    -------
    int
        Exit status.
    """
    options = parser().parse_args(list(arguments))
    try:
        return _solve(options)
    except notices.BadInput as error:
        _tell(error.notices)
        return _failed("nothing was written")
    except (luz.LuzEspecularError, MemoryError) as error:
        return _failed(solver_message(error))
    except OSError as error:
        return _failed(str(error))
    except KeyboardInterrupt:
        _failed("interrupted")
        return 130


def parser() -> argparse.ArgumentParser:
    """Return the command line; what is not given stays as the .blend has it."""
    top = argparse.ArgumentParser(
        prog="luzespecular", description="Daylight in lux on every surface, mirrors and glass included."
    )
    actions = top.add_subparsers(dest="action", required=True)
    solve = actions.add_parser(
        "solve",
        help="solve the open .blend and write tables and copies of the .blend",
        description="Solve the open .blend. Whatever is not given here stays as the .blend has it.",
    )
    add = solve.add_argument
    add("--out", type=Path, required=True, metavar="FOLDER", help="where to write; made if absent")
    add("--scene", metavar="NAME", help="scene to solve (default: the active one)")
    add("--hours", type=terminal.hours_of_day, metavar="H[,H…]", help="hours of the day, e.g. 9,10.5,12:15")
    add("--date", type=terminal.iso_date, metavar="YYYY-MM-DD", help="date")
    add("--time", choices=("solar", "clock"), help="what the hours mean")
    add("--sky", choices=("clear", "intermediate", "overcast", "cie", "none"), help="sky")
    add("--cie-type", type=int, choices=range(1, 17), metavar="1…16", help="CIE sky (sets --sky cie)")
    add("--no-sun", action="store_true", help="leave the Sun out")
    add("--fineness", choices=("draft", "normal", "fine", "error", "expert"), help="how finely to calculate")
    for option, group, name, explanation in _NUMBERS:
        add(option, type=_number(group, name), metavar="N", help=explanation)
    add(
        "--format",
        type=terminal.formats_of(*FORMATS),
        default=("csv", "blend"),
        metavar="F[,F…]",
        help="what to write: csv (tables), json (all in one file), png (pictures with a legend), blend (copies with "
        "their results); default: csv,blend",
    )
    add("--no-faces", action="store_true", help="leave the single faces out of the tables")
    add("--no-blend", action="store_true", help="do not write copies of the .blend")
    return top


def _solve(options: argparse.Namespace) -> int:
    scene = _scene(options.scene)
    settings = scene.luzespecular
    _apply(options, settings)
    formats = {*options.format} - ({"blend"} if options.no_blend else set())
    hours = options.hours or [settings.site.hour]
    options.out.mkdir(parents=True, exist_ok=True)
    stem = Path(bpy.data.filepath).stem or "untitled"
    overview: list[tuple[str, ...]] = []
    documents: list[dict] = []
    told: set[notices.Notice] = set()
    with bpy.context.temp_override(scene=scene, view_layer=scene.view_layers[0]):
        for hour, planned in _plans(settings, hours):
            settings.site.hour = hour
            _tell_new(planned.notices, told)
            solved = _run(planned)
            result = solved.result
            _tell_new(study.finish(bpy.context, planned, result, solved.readings), told)
            rows = _print_table(planned, result)
            moment = f"{light.date_of(settings.site).isoformat()} {terminal.clock(hour)}"
            kind = settings.site.time_kind.lower()
            overview += [(moment, kind, *tables.surface_row(row)) for row in rows]
            receivers = dict.fromkeys(row.name for row in rows)
            path = options.out / f"{stem}_{moment.replace(' ', '_').replace(':', 'h')}"
            if "csv" in formats and not options.no_faces:
                header, faces = tables.face_rows(result, receivers)
                _written(files.write_csv(_with_name(path, "_faces.csv"), header, faces))
            if "csv" in formats and solved.readings:
                points = work_planes.rows(scene, planned.export.unit_scale)
                _written(files.write_csv(_with_name(path, "_work_planes.csv"), work_planes.HEADER, points))
            if "json" in formats:
                documents.append(_document(moment, kind, settings.site, solved, rows, not options.no_faces))
            if "png" in formats:
                _written(pictures.save(scene, _with_name(path, ".png")))
            if "blend" in formats:
                _written(_save_blend(_with_name(path, ".blend")))
    if "csv" in formats:
        header = ("moment", "time", *tables.SURFACE_HEADER)
        _written(files.write_csv(options.out / f"{stem}_surfaces.csv", header, overview))
    if "json" in formats:
        content = {"file": bpy.data.filepath, "scene": scene.name, "moments": documents}
        _written(files.write_json(options.out / f"{stem}.json", content))
    return 0


def _with_name(path: Path, ending: str) -> Path:
    return path.with_name(path.name + ending)


def _document(moment: str, kind: str, site, solved: job.Job, rows, faces: bool) -> dict:
    """What the JSON file says of one hour: as the console command's, with work planes for points."""
    place = light.sun_place(site)
    points = {reading.grid.object_name: reading.values for reading in solved.readings}
    return {
        "moment": moment,
        "time": kind,
        "sun_altitude": place.altitude,
        "sun_azimuth": place.azimuth,
        **tables.document(solved.result, rows, points, dict.fromkeys(row.name for row in rows) if faces else None),
    }


def _plans(settings: bpy.types.PropertyGroup, hours: list[float]) -> list[tuple[float, study.Study]]:
    """Collect all hours before any is solved, so that nothing has been written where one is refused."""
    plans: list[tuple[float, study.Study]] = []
    for hour in hours:
        settings.site.hour = hour
        exported = plans[0][1].export if plans else None
        plans.append((hour, study.collect(bpy.context, exported)))
    return plans


def _scene(name: str | None) -> bpy.types.Scene:
    if name is None:
        return bpy.context.scene
    scene = bpy.data.scenes.get(name)
    if scene is None:
        known = ", ".join(f"'{scene.name}'" for scene in bpy.data.scenes)
        raise notices.refuse(rpt_("There is no scene '{name}': choose one of {known}").format(name=name, known=known))
    for window in bpy.context.window_manager.windows:
        window.scene = scene
    return scene


def _apply(options: argparse.Namespace, settings: bpy.types.PropertyGroup) -> None:
    site, sky, accuracy = settings.site, settings.sky, settings.accuracy
    if options.date is not None:
        site.year, site.month, site.day = options.date.year, options.date.month, options.date.day
    if options.time is not None:
        site.time_kind = options.time.upper()
    if options.cie_type is not None:
        sky.kind, sky.cie_type = "CIE", str(options.cie_type)
    if options.sky is not None:
        sky.kind = options.sky.upper()
    if options.no_sun:
        sky.use_sun = False
    if options.sky_illuminance is not None or options.sun_illuminance is not None:
        sky.illuminance_from = "VALUE"
    if options.error is not None:
        accuracy.fineness = "ERROR"
    if options.bands is not None or options.max_area is not None:
        accuracy.fineness = "EXPERT"
    if options.fineness is not None:
        accuracy.fineness = options.fineness.upper()
    for option, group, name, _ in _NUMBERS:
        value = getattr(options, option.removeprefix("--").replace("-", "_"))
        if value is not None:
            setattr(getattr(settings, group), name, value)


def _run(planned: study.Study) -> job.Job:
    running = job.Job(planned, session.current)
    running.start()
    show = terminal.Progress()
    try:
        while not running.finished:
            latest = running.latest(timeout=0.1)
            if latest is not None:
                show(*latest)
    except KeyboardInterrupt:
        running.cancel()
        running.wait()
        raise
    finally:
        show.end()
    if running.error is not None:
        raise running.error
    return running


def _print_table(planned: study.Study, result: luz.Result) -> list[tables.SurfaceStatistics]:
    receivers = [surface.name for surface in planned.export.surfaces if surface.receiver]
    rows = tables.surface_statistics(result, receivers)
    terminal.print_statistics(f"{planned.title}; {len(result.illuminance)} faces", rows)
    return rows


def _save_blend(path: Path) -> Path:
    """Save a copy of the file that is open, which appears only when complete and never takes its place."""
    if bpy.data.filepath and path.resolve() == Path(bpy.data.filepath).resolve():
        raise notices.refuse(rpt_("'{path}' is the file that is open: choose another --out").format(path=path))
    unfinished = path.with_name(path.stem + ".part.blend")
    try:
        bpy.ops.wm.save_as_mainfile(filepath=str(unfinished.resolve()), copy=True, check_existing=False)
        unfinished.replace(path)
    except RuntimeError as error:  # Blender's own way to say that it could not write
        raise OSError(str(error).strip()) from error
    finally:
        unfinished.unlink(missing_ok=True)
    return path


def _written(path: Path) -> None:
    print(f"wrote {path}")


def _tell_new(remarks: Iterable[notices.Notice], told: set[notices.Notice]) -> None:
    _tell(notice for notice in remarks if notice not in told)
    told.update(remarks)


def _tell(remarks) -> None:
    for notice in remarks:
        print(f"{notice.level.lower()}: {notice.text}", file=sys.stderr)


def _failed(reason: str) -> int:
    print(f"luzespecular: failed: {reason}", file=sys.stderr)
    return 1


def _number(group: str, name: str):
    """Return a reader of numbers that refuses what the property would clamp."""
    kind = bpy.types.Scene.bl_rna.properties["luzespecular"].fixed_type.properties[group].fixed_type.properties[name]

    def read(text: str) -> float:
        try:
            value = int(text) if kind.type == "INT" else float(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"'{text}' is no number") from None
        if not kind.hard_min <= value <= kind.hard_max:
            raise argparse.ArgumentTypeError(f"{value:g} is out of range: give {kind.hard_min:g} to {kind.hard_max:g}")
        return value

    return read
