"""Where the time goes: stages, growth, skips, the cost model; beside Embree and beside Radiance.

    python benchmarks/performance.py [--parts stages growth ...] [--minutes 10] [--docs] [--output build/performance]

Every measurement runs in a process of its own, so that none disturbs another and peak memory is its own; what is to be
compared runs in turn within one process, or one after the other in one run. Medians of several runs where the budget of
minutes allows; what does not fit, by what was measured before, is left out, and the tables say so. Parts that were
measured at the same commit stay until they are measured again. ``--docs`` writes page and picture into docs/.

Embree and Radiance are optional: ``python -m pip install -e ".[engines]"``. Without them their tables say so.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib.metadata
import json
import os
import time
from pathlib import Path

import apart
import beside_embree
import beside_radiance
import cost_model
import numpy as np
import performance_page
import rooms
import scenes
import solver_side
from apart import ROOT

import luzespecular as luz

PARTS = {"stages": 1.5, "model": 0.5, "embree": 0.5, "skips": 2.5, "growth": 2.5, "radiance": 2.5}
"""In the order in which they are measured, with their shares of the budget."""

REUSES = (
    "another hour",
    "another hour, quick",
    "another sky",
    "a sky's luminance, 6,000 directions",
    "another reflectance",
    "loaded",
    "saved",
    "a year",
)
USUAL_FACE = 0.005
"""Largest face of the light-shelf room [m²], as in the paper."""

SOLVER_BANDS = (10, 20, 40, 60)
"""Of the solver beside Radiance."""

PLACES = "seed_room_noon"


def faces_by_solver(bands: int, max_area: float, threads: int, repeats: int, most_seconds: float, faces: str) -> dict:
    """Seconds from arrays to lux on all faces, and the error at the known places; keeps where the faces are."""
    scene = scenes.load(PLACES)
    (measure,) = scene.measures
    given, kept = scene.solver_scene(), []

    def run() -> None:
        kept.clear()
        kept[:] = [luz.prepare(given, bands=bands, max_area=max_area, threads=threads).solve(measure.light)]

    seconds, runs = apart.medians({"all": run}, repeats, most_seconds)
    peak, (result,) = apart.peak_gb(), kept
    np.savez(faces, points=result.centroids, normals=result.normals)
    found = errors(measure, result.at(measure.points, measure.normals))
    return found | {"seconds": seconds["all"], "runs": runs, "peak_gb": peak, "faces": len(result.areas)}


def faces_by_radiance(setting: dict, most_faces: int, threads: int, faces: str) -> dict:
    """The same by Radiance, at the middles of the same faces and at the known places."""
    scene = scenes.load(PLACES)
    (measure,) = scene.measures
    with np.load(faces) as content:
        points, normals = content["points"][:most_faces], content["normals"][:most_faces]
    points = np.concatenate([measure.points, points])
    normals = np.concatenate([measure.normals, normals])
    start = time.perf_counter()
    lux = beside_radiance.trace(scene, measure.light, points, normals, setting, threads)
    seconds = time.perf_counter() - start
    found = errors(measure, lux[: len(measure.lux)])
    return found | {"seconds": seconds, "runs": 1, "peak_gb": apart.peak_gb(children=True), "faces": len(points)}


def errors(measure: scenes.Measure, lux) -> dict:
    """Errors at places with known illuminance, in percent: of each place's own value, and of the mean of all."""
    found = 100 * measure.errors(lux)
    absolute = np.asarray(lux, float) - measure.lux
    return {
        "rms": float(np.sqrt(np.mean(found**2))),
        "median": float(np.median(np.abs(found))),
        "largest": float(np.abs(found).max()),
        "mean": float(found.mean()),
        "of_mean": float(100 * np.sqrt(np.mean(absolute**2)) / measure.lux.mean()),
    }


TASKS = {
    "first use": solver_side.first_use,
    "whole run": solver_side.whole_run,
    "reuse": solver_side.reuse,
    "growth": solver_side.growth,
    "skip": solver_side.skip,
    "embree": beside_embree.compare,
    "model": cost_model.measure,
    "solver": faces_by_solver,
    "radiance": faces_by_radiance,
}


class Bench:
    """Measures part by part; ``state`` is what comes out."""

    def __init__(self, args, state: dict):
        self.args, self.state = args, state
        self.end = 0.0
        self.common = {"threads": args.threads, "repeats": args.repeats}
        self.room = self.common | {"bands": args.bands, "max_area": args.max_area}

    @property
    def left(self) -> float:
        """Seconds of the current part's budget."""
        return self.end - time.perf_counter()

    def do(self, task: str, least: float = 0.0, **given) -> dict:
        """One task, where its ``least`` seconds fit into what is left of the part's budget."""
        if least > self.left or self.left < 1:
            row = {"failed": "left out: over the budget of minutes"}
        else:
            row = apart.run(__file__, {"task": task, "coarse": self.args.quick, **given}, self.left)
        about = ", ".join(f"{v:g}" if isinstance(v, float) else str(v) for v in given.values())
        print(f"{task:10} {about[:70]:72}{row.get('failed') or performance_page.summary(row)}", flush=True)
        return row

    def stages(self) -> dict:
        """The light-shelf room from arrays to lux, and what is done with its transfer."""
        transfer = str(self.args.output / "transfer.npz")
        whole = self.do("whole run", **self.room, most_seconds=self.left / 3, transfer=transfer)
        first = self.do("first use", **self.room, most_seconds=self.left / 6)
        rows = {}
        if "failed" not in whole:
            for k, what in enumerate(REUSES):
                most = self.left / (len(REUSES) - k) / 2
                given = self.common | {"most_seconds": most, "transfer": transfer, "hours": self.args.hours}
                rows[what] = self.do("reuse", what=what, **given)
        return {"whole": whole, "first": first, "reuse": rows}

    def growth(self) -> dict:
        """One thing after the other grows: the seconds of each size foretell those of the next."""
        out, end = {}, self.end
        kinds = list(solver_side.GROWTH)
        for k, kind in enumerate(kinds):
            self.end = time.perf_counter() + (end - time.perf_counter()) / (len(kinds) - k)
            sizes = solver_side.GROWTH[kind][: self.args.sizes]
            coarse = {"bands": min(solver_side.BANDS_OF_GROWTH, self.args.bands)}
            coarse["max_area"] = max(solver_side.FACE_OF_GROWTH, self.args.max_area)
            usual = self.room if kind in ("faces", "bands") else self.common | coarse
            rows, walls = [], []
            for value in sizes:
                value = value * self.args.max_area / USUAL_FACE if kind == "faces" else value
                times = walls[-1] / walls[-2] if len(walls) > 1 else 1.0
                least = walls[-1] * max(1.0, times) if walls else 0.0
                most = self.left / len(sizes) / 2
                row = self.do("growth", least, kind=kind, value=value, **usual, most_seconds=most)
                rows.append({"value": value} | row)
                if "failed" in row:
                    break
                walls.append(row["wall"] - (row["runs"] - 1) * row["seconds"])
            out[kind] = rows
        self.end = end
        return out

    def skips(self) -> dict:
        """Each with it and without it, in turn."""
        out = {}
        often = self.room | {"repeats": 1 if self.args.quick else 4 * self.args.repeats}
        for k, name in enumerate(solver_side.SKIPS):
            most = 0.6 * self.left / (len(solver_side.SKIPS) - k)
            out[name] = self.do("skip", name=name, **often, most_seconds=most)
        return out

    def embree(self) -> dict:
        """Directions per second."""
        return self.do("embree", **self.room, most_seconds=self.left / 3)

    def model(self) -> dict:
        """Predicted and measured seconds of the hot path, on one thread."""
        return self.do("model", bands=self.args.bands, max_area=self.args.max_area, most_seconds=self.left / 3)

    def radiance(self) -> dict:
        """The solver at several bands, Radiance at several settings: seconds and error."""
        faces = str(self.args.output / "faces.npz")
        out: dict = {"solver": [], "radiance": [], "installed": beside_radiance.available()}
        out["noise"] = 100 * scenes.load(PLACES).measures[0].noise
        some = [bands for bands in SOLVER_BANDS if bands < self.args.bands] + [self.args.bands]
        for bands in some:
            given = self.room | {"bands": bands, "most_seconds": self.left / 20, "faces": faces}
            out["solver"].append({"label": f"{bands} bands"} | self.do("solver", **given))
        if not out["installed"] or "failed" in out["solver"][-1]:
            return out
        slow: dict[bool, tuple[float, float]] = {}
        for setting in beside_radiance.QUICK if self.args.quick else beside_radiance.SETTINGS:
            cost, cached = beside_radiance.cost(setting), setting["cache"]
            seconds, before = slow.get(cached, (0.0, cost))
            row = self.do(
                "radiance",
                seconds * cost / before / (3 if cached else 1),
                setting=setting,
                most_faces=self.args.most_faces,
                threads=self.args.threads,
                faces=faces,
            )
            out["radiance"].append({"label": beside_radiance.label(setting), "cache": cached} | row)
            if "failed" not in row:
                slow[cached] = row["seconds"], cost
        return out


def versions() -> dict:
    """Of the engines that are installed."""
    found = {}
    for name in ("embreex", "pyradiance"):
        try:
            found[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            continue
    return found


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("--parts", nargs="+", choices=list(PARTS), default=list(PARTS))
    ap.add_argument("--minutes", type=float, default=10.0, help="budget for all parts together")
    ap.add_argument("--bands", type=int, default=60)
    ap.add_argument("--max-area", type=float, default=USUAL_FACE, help="largest face [m²]")
    ap.add_argument("--repeats", type=int, default=5, help="runs whose median counts, where the budget allows")
    ap.add_argument("--threads", type=int, default=os.cpu_count() or 1)
    ap.add_argument("--quick", action="store_true", help="8 bands, few faces, one run: only to see that it runs")
    ap.add_argument("--output", type=Path, default=ROOT / "build" / "performance")
    ap.add_argument("--docs", action="store_true", help="write docs/performance.md and its picture")
    ap.add_argument("--one", help=argparse.SUPPRESS)
    args = ap.parse_args()
    if args.one:
        task = json.loads(args.one)
        coarse = rooms.coarsely() if task.pop("coarse") else contextlib.nullcontext()
        with coarse:
            print(json.dumps(TASKS[task.pop("task")](**task)))
        return
    args.sizes, args.most_faces, args.hours = None, None, solver_side.HOURS_OF_YEAR
    if args.quick:
        args.bands, args.max_area, args.repeats, args.sizes, args.most_faces, args.hours = 8, 0.1, 1, 2, 20, 48
    args.output.mkdir(parents=True, exist_ok=True)
    path = args.output / "measurements.json"
    about = apart.about(args.threads) | {"minutes": args.minutes, "engines": versions()}
    state = apart.kept_before(path, about) | {"about": about}
    bench = Bench(args, state)
    end = time.perf_counter() + 60 * args.minutes
    parts = [name for name in PARTS if name in args.parts]
    for k, name in enumerate(parts):
        weights = [PARTS[other] for other in parts[k:]]
        bench.end = time.perf_counter() + (end - time.perf_counter()) * weights[0] / sum(weights)
        state[name] = getattr(bench, name)()
        path.write_text(json.dumps(state, indent=1) + "\n", encoding="utf-8")
    for name in ("transfer.npz", "transfer.again.npz", "faces.npz"):
        (args.output / name).unlink(missing_ok=True)
    performance_page.draw(state, args.output / "performance.png")
    text = performance_page.page(state, "performance.png")
    (args.output / "performance.md").write_text(f"# Performance\n\n{text}", encoding="utf-8")
    if args.docs:
        performance_page.write_docs(state, ROOT / "docs")
    print(f"\n{args.output / 'performance.md'}")


if __name__ == "__main__":
    main()
