"""The console command: ``luzespecular solve scene.json --latitude … --date … --out folder``, ``luzespecular sun …``.

Exit status: 0 done, 1 a file that cannot be read or written, 2 bad input (arguments, scene or light), 130 interrupted.
"""

from __future__ import annotations

import argparse
import datetime as dt
import logging
import sys
import zoneinfo
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from . import files, tables
from . import sun as ephemeris
from .availability import default_daylight
from .daylight import Daylight
from .errors import LuzEspecularError, SceneError
from .preparation import prepare
from .result import Result
from .sky_cie import CIESky
from .sun import Sun
from .terminal import Progress, clock, formats_of, hours_of_day, iso_date, print_statistics

_AVAILABLE_SKIES = ("clear", "intermediate", "overcast")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : sequence of str, optional
        What follows ``luzespecular`` on the command line; None (default): that of this process.

    Returns
    -------
    int
        Exit status.
    """
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a terminal that lacks a letter of a name is no reason to fail
    # on a terminal over the line of the progress, which begins anew below
    logging.basicConfig(format="\rwarning: %(message)-60s" if sys.stderr.isatty() else "warning: %(message)s")
    options = parser().parse_args(arguments)
    try:
        options.run(options)
    except SceneError as error:
        return _failed(str(error), 2)
    except (LuzEspecularError, OSError, ArithmeticError, MemoryError) as error:
        return _failed(str(error) or "there is not enough memory: raise --max-area or lower --bands", 1)
    except KeyboardInterrupt:
        return _failed("interrupted", 130)
    return 0


def parser() -> argparse.ArgumentParser:
    """Return the command line."""
    from . import __version__

    top = argparse.ArgumentParser(
        prog="luzespecular", description="Daylight in lux on every surface, mirrors and glass included."
    )
    top.add_argument("--version", action="version", version=f"luzespecular {__version__}")
    actions = top.add_subparsers(dest="action", required=True)
    solve = actions.add_parser(
        "solve",
        help="solve a scene and write tables",
        description="Solve a scene file (JSON; docs/user-guide.md says how it is written) and write tables of lux.",
    )
    solve.set_defaults(run=_solve)
    add = solve.add_argument
    add("scene", type=Path, metavar="SCENE.json", help="surfaces and materials; metres, Z up")
    add("--out", type=Path, required=True, metavar="FOLDER", help="where to write; made if absent")
    _add_site(solve)
    add("--hours", type=hours_of_day, default=[12.0], metavar="H[,H…]", help="e.g. 9,10.5,12:15 (default: 12)")
    add("--north", type=float, default=0.0, metavar="N", help="angle in degrees from +Y to true north, clockwise")
    add("--sky", choices=(*_AVAILABLE_SKIES, "cie", "none"), help="sky (default: clear)")
    add("--cie-type", type=int, choices=range(1, 17), metavar="1…16", help="CIE sky (sets --sky cie; default: 12)")
    add("--sky-illuminance", type=float, metavar="N", help="lx by the sky on an open horizontal plane (--sky cie)")
    add("--sun-illuminance", type=float, metavar="N", help="lx by the Sun on a plane facing it (--sky cie or none)")
    add("--no-sun", action="store_true", help="leave the Sun out")
    add("--ground", type=float, default=0.2, metavar="N", help="reflectance of the ground around (default: 0.2)")
    add("--bands", type=int, default=60, metavar="N", help="bands of the globe (default: 60)")
    add("--max-area", type=float, metavar="N", help="largest face in m² (default: chosen for the scene)")
    add("--cycles", type=int, metavar="N", help="diffuse reflections (default: all that count)")
    add("--threads", type=int, metavar="N", help="default: as many as there are cores")
    add("--memory", type=float, metavar="GB", help="refuse what needs more")
    add("--receivers", action="append", metavar="NAME", help="a surface whose faces are wanted (again for more)")
    add("--cache", type=Path, metavar="FILE", help="keep what takes long there, and use it where it still holds")
    add(
        "--format",
        type=formats_of("csv", "json", "npz"),
        default=("csv",),
        metavar="F[,F…]",
        help="csv, json, npz (default: csv)",
    )
    add("--no-faces", action="store_true", help="leave the single faces out of CSV and JSON")
    sun = actions.add_parser(
        "sun",
        help="print the Sun's positions, sunrise and sunset",
        description="Print where the Sun stands, hour by hour, and when it rises and sets.",
    )
    sun.set_defaults(run=_sun)
    _add_site(sun)
    sun.add_argument("--hours", type=hours_of_day, metavar="H[,H…]", help="default: every hour with the Sun up")
    return top


def _add_site(command: argparse.ArgumentParser) -> None:
    add = command.add_argument
    add("--latitude", type=float, required=True, metavar="N", help="degrees, north positive")
    add("--longitude", type=float, metavar="N", help="degrees, east positive (needed with --time-zone)")
    add("--date", type=iso_date, required=True, metavar="YYYY-MM-DD", help="date")
    add(
        "--time-zone",
        "--utc-offset",
        type=_zone,
        metavar="ZONE",
        help="hours are clock time: hours ahead of UTC (-3) or a name (America/Sao_Paulo); else hours are solar time",
    )


@dataclass(frozen=True)
class _Moment:
    """One hour: what it is called, where the Sun stands, and the light."""

    title: str
    kind: str
    altitude: float
    azimuth: float
    light: Daylight

    @property
    def file_name(self) -> str:
        return self.title.replace(" ", "_").replace(":", "h")


def _solve(options: argparse.Namespace) -> None:
    given = files.read_scene(options.scene)
    luminous = any(surface.material.exitance > 0.0 for surface in given.scene.surfaces.values())
    moments = [_moment(options, hour, luminous) for hour in dict.fromkeys(options.hours)]
    options.out.mkdir(parents=True, exist_ok=True)
    progress = Progress()
    try:
        transfer = prepare(
            given.scene,
            bands=options.bands,
            max_area=options.max_area,
            threads=options.threads,
            memory=None if options.memory is None else 1e9 * options.memory,
            receivers=options.receivers,
            cache=options.cache,
            progress=progress,
        )
    finally:
        progress.end()
    for stage in transfer.stages:
        if options.cache is not None and (stage.name == "cache" or "taken from" in stage.skipped) and stage.skipped:
            print(f"{stage.name}: {stage.skipped}")
    stem = options.scene.stem
    surface_rows: list[tuple] = []
    point_rows: list[tuple] = []
    documents: list[dict] = []
    for moment in moments:
        result = transfer.solve(moment.light, cycles=options.cycles)
        statistics = tables.surface_statistics(result, result.surfaces)
        print_statistics(f"{moment.title} {moment.kind} time; {len(result.illuminance)} faces", statistics)
        surface_rows += [(moment.title, moment.kind, *tables.surface_row(row)) for row in statistics]
        lux = {name: tables.point_quantities(result, p.positions, p.normals) for name, p in given.points.items()}
        for name, points in given.points.items():
            rows = np.column_stack([points.positions, *lux[name].values()]).tolist()
            point_rows += [(moment.title, moment.kind, name, *row) for row in rows]
        if "csv" in options.format and not options.no_faces:
            header, faces = tables.face_rows(result, result.surfaces)
            _written(files.write_csv(options.out / f"{stem}_{moment.file_name}_faces.csv", header, faces))
        if "npz" in options.format:
            path = options.out / f"{stem}_{moment.file_name}.npz"
            _written(files.write_arrays(path, tables.arrays(result)))
        if "json" in options.format:
            documents.append(_document(moment, result, statistics, lux, not options.no_faces))
    if "csv" in options.format:
        header = ["moment", "time", *tables.SURFACE_HEADER]
        _written(files.write_csv(options.out / f"{stem}_surfaces.csv", header, surface_rows))
        if given.points:
            header = ["moment", "time", "points", "x_m", "y_m", "z_m", *(f"{q}_lx" for q in tables.QUANTITIES)]
            _written(files.write_csv(options.out / f"{stem}_points.csv", header, point_rows))
    if "json" in options.format:
        _written(files.write_json(options.out / f"{stem}.json", {"scene": stem, "moments": documents}))


def _moment(options: argparse.Namespace, hour: float, luminous: bool) -> _Moment:
    altitude, azimuth = _sun_place(options, hour)
    title = f"{options.date.isoformat()} {clock(hour)}"
    light = _light(options, altitude, azimuth)
    if light.sky is None and light.sun is None and not luminous:
        raise SceneError(
            f"There is no light at {title}: the Sun is down or off, there is no sky, no surface is luminous; "
            "choose another hour or sky"
        )
    return _Moment(title, "solar" if options.time_zone is None else "clock", altitude, azimuth, light)


def _sun_place(options: argparse.Namespace, hour: float) -> tuple[float, float]:
    """Altitude and azimuth of the Sun [degrees] at an hour of the day, clock time with a time zone, else solar time."""
    midnight = dt.datetime.combine(options.date, dt.time())
    if options.time_zone is not None:
        longitude = _longitude(options)
        when = (midnight + dt.timedelta(hours=hour)).replace(tzinfo=options.time_zone)
        return ephemeris.sun_position(options.latitude, longitude, when)
    mean = midnight.replace(tzinfo=dt.UTC) + dt.timedelta(hours=hour - _longitude(options) / 15.0)
    return ephemeris.sun_position_solar(options.latitude, ephemeris.declination(mean), hour)


def _longitude(options: argparse.Namespace) -> float:
    if options.longitude is None and options.time_zone is not None:
        raise SceneError("--time-zone needs --longitude: where the Sun stands by the clock depends on both")
    return options.longitude or 0.0


def _light(options: argparse.Namespace, altitude: float, azimuth: float) -> Daylight:
    kind = options.sky or ("clear" if options.cie_type is None else "cie")
    if options.cie_type is not None and kind != "cie":
        raise SceneError(f"--cie-type does not go with --sky {kind}; leave out one of the two")
    azimuth = (azimuth + options.north) % 360.0
    if kind in _AVAILABLE_SKIES:
        for option in ("sky_illuminance", "sun_illuminance"):
            if getattr(options, option) is not None:
                raise SceneError(
                    f"--{option.replace('_', '-')} does not go with --sky {kind}, which has illuminances of its own; "
                    "choose --sky cie to give them"
                )
        day = options.date.timetuple().tm_yday
        light = default_daylight(kind, altitude, azimuth, day, options.ground)
        return replace(light, sun=None) if options.no_sun else light
    sky = sun = None
    if kind == "cie":
        if options.sky_illuminance is None:
            raise SceneError("--sky cie needs --sky-illuminance: lx by the sky alone on an open horizontal plane")
        # at night a given sky keeps the pattern that it has with the Sun on the horizon
        sky = CIESky(
            options.cie_type or 12,
            sun_altitude=max(altitude, 0.0),
            sun_azimuth=azimuth,
            horizontal_illuminance=options.sky_illuminance,
        )
    elif options.sky_illuminance is not None:
        raise SceneError("--sky-illuminance does not go with --sky none; choose --sky cie")
    if not options.no_sun:
        if options.sun_illuminance is None:
            raise SceneError(f"--sky {kind} needs --sun-illuminance, lx on a plane that faces the Sun, or --no-sun")
        if altitude > 0.0 and options.sun_illuminance != 0.0:
            sun = Sun(altitude=altitude, azimuth=azimuth, normal_illuminance=options.sun_illuminance)
    return Daylight(sky=sky, sun=sun, ground_reflectance=options.ground)


def _document(moment: _Moment, result: Result, statistics, lux: dict[str, dict], faces: bool) -> dict[str, Any]:
    """What the JSON file says of one hour."""
    return {
        "moment": moment.title,
        "time": moment.kind,
        "sun_altitude": moment.altitude,
        "sun_azimuth": moment.azimuth,
        **tables.document(result, statistics, lux, result.surfaces if faces else None),
    }


def _sun(options: argparse.Namespace) -> None:
    longitude = _longitude(options)
    places = {hour: _sun_place(options, hour) for hour in options.hours or map(float, range(24))}
    if options.hours is None:
        places = {hour: place for hour, place in places.items() if place[0] > 0.0}
    noon = dt.datetime.combine(options.date, dt.time(12), dt.UTC) - dt.timedelta(hours=longitude / 15.0)
    events = ephemeris.sunrise_sunset(options.latitude, longitude, options.date)
    kind = "solar" if options.time_zone is None else "clock"
    print(f"{options.date.isoformat()}, latitude {options.latitude:g}°, longitude {longitude:g}°, {kind} time")
    print(
        f"declination {ephemeris.declination(noon):.2f}°, equation of time {ephemeris.equation_of_time(noon):.1f} min"
    )
    if None in events:
        print("the Sun neither rises nor sets")
    else:
        rise, fall = (clock(_hour_of(event, options, longitude)) for event in events if event is not None)
        print(f"sunrise {rise}, sunset {fall}")
    print(" hour  altitude  azimuth")
    for hour, (altitude, azimuth) in places.items():
        print(f"{clock(hour)}  {altitude:8.2f}  {azimuth:7.2f}")


def _hour_of(instant: dt.datetime, options: argparse.Namespace, longitude: float) -> float:
    if options.time_zone is None:
        return ephemeris.solar_time(longitude, instant)
    local = instant.astimezone(options.time_zone)
    return local.hour + local.minute / 60.0 + local.second / 3600.0


def _written(path: Path) -> None:
    print(f"wrote {path}")


def _failed(reason: str, status: int) -> int:
    print(f"luzespecular: failed: {reason}", file=sys.stderr)
    return status


def _zone(text: str) -> dt.tzinfo:
    try:
        return dt.timezone(dt.timedelta(hours=float(text)))
    except (ValueError, OverflowError):
        pass
    try:
        return zoneinfo.ZoneInfo(text)
    except (zoneinfo.ZoneInfoNotFoundError, ValueError, OSError):
        raise argparse.ArgumentTypeError(
            f"'{text}' is no time zone: write hours ahead of UTC such as -3 or 5.5, or a name such as America/Sao_Paulo"
        ) from None


if __name__ == "__main__":
    sys.exit(main())
