"""Run time against error: the solver and the method as published, beside each other.

    python benchmarks/time_and_error.py [--quick] [--scenes seed_room louvres ...] [--output build/time_and_error]

Each scene of ``data/`` is solved by both methods with the same bands and faces, and held against its reference. Every
setting runs in a process of its own, so that its peak memory is its own; three times where the budget of seconds
allows, and the median counts. The whole ends within ``--minutes``: each scene gets its share of what is left, half for
either method, and what does not fit, by what coarser settings took, is left out and said to be. What is measured is
kept in ``measurements.json`` after every setting: a run that was broken off goes on where it stopped, and begins anew
at another commit. ``--docs`` writes page and picture into docs/.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import time
from pathlib import Path

import apart
import hit_or_miss
import numpy as np
import scenes
from apart import ROOT, percent

import luzespecular as luz

METHODS = {"published": "one direction per parcel", "solver": "LuzEspecular"}
BANDS = (20, 40, 60, 90, 120)
USUAL = 60
"""Bands up to here come first, then accuracies; finer ones have what is left of the budget."""

TRIAL_BANDS = 30
"""Of the trial solution with which the solver meets an accuracy."""

ACCURACIES = (0.03, 0.01)
REPEATS = 3
OF_BUDGET = 0.2
"""Share of a method's budget within which a setting is run again, for its median."""

LARGE = {"furnished": 3.0}
"""Scenes that get this many shares of the budget."""
MARK = "<!-- From here on written by benchmarks/time_and_error.py -->"


def errors(measure: scenes.Measure, lux) -> dict:
    """Relative errors of one measure, in percent."""
    found = 100 * measure.errors(lux)
    return {
        "rms": float(np.sqrt(np.mean(found**2))),
        "largest": float(found[np.argmax(np.abs(found))]),
        "mean": float(found.mean()),
        "values": len(found),
    }


def run_published(scene: scenes.BenchmarkScene, setting: dict, threads: int) -> dict:
    """Seconds and errors of the published method."""
    start = time.perf_counter()
    solved = hit_or_miss.HitOrMiss(
        scene.surfaces,
        [m.light for m in scene.measures],
        bands=setting["bands"],
        max_area=scene.max_area,
        threads=threads,
    )
    seconds = time.perf_counter() - start
    found = {m.label: errors(m, solved.at(m.points, m.normals, k, m.initial)) for k, m in enumerate(scene.measures)}
    return {"seconds": seconds, "faces": solved.faces.count, "errors": found}


def stated(measure: scenes.Measure, result, lux) -> dict:
    """What the solver says of its own error at the faces under the places compared [%], and how many keep within it.

    The reference's noise is allowed for: twice its standard error.
    """
    away = np.linalg.norm(measure.points[:, None] - result.centroids[None], axis=2)
    face = np.argmin(np.where(measure.normals @ result.normals.T > 0.999, away, np.inf), axis=1)
    told = result.error[face]
    within = np.abs(lux - measure.lux) <= told + 2 * measure.standard_error
    return {"stated": float(100 * np.median(told / measure.scale)), "within": float(100 * within.mean())}


def run_solver(scene: scenes.BenchmarkScene, setting: dict, threads: int) -> dict:
    """Seconds and errors of the solver."""
    given = scene.solver_scene()
    start = time.perf_counter()
    fineness = {} if "accuracy" in setting else {"max_area": scene.max_area}  # where asked for, the solver chooses
    transfer = luz.prepare(given, threads=threads, **fineness, **setting)
    prepared = time.perf_counter()
    results = [transfer.solve(m.light) for m in scene.measures]
    end = time.perf_counter()
    found = {}
    for measure, result in zip(scene.measures, results, strict=True):
        lux = result.at(measure.points, measure.normals, initial=measure.initial)
        found[measure.label] = errors(measure, lux)
        if not measure.initial:
            found[measure.label] |= stated(measure, result, lux)
    return {
        "seconds": end - start,
        "prepare": prepared - start,
        "faces": len(results[0].areas),
        "errors": found,
    }


def run_here(scene_name: str, method: str, setting: dict, threads: int, most_seconds: float, repeats: int) -> dict:
    """Measure one setting in this process: the median of up to ``repeats`` runs that fit into ``most_seconds``."""
    scene = scenes.load(scene_name)
    run = {"published": run_published, "solver": run_solver}[method]
    start, runs = time.perf_counter(), []
    while len(runs) < repeats:
        runs.append(run(scene, setting, threads))
        if time.perf_counter() - start + runs[-1]["seconds"] > most_seconds:
            break
    out = runs[-1]
    for key in {"seconds", "prepare"} & out.keys():
        out[key] = statistics.median(r[key] for r in runs)
    return out | {"runs": len(runs), "peak_gb": apart.peak_gb()}


def settings(bands: list[int], accuracies: list[float]) -> list[tuple[str, dict]]:
    """Methods and settings in the order in which they are measured."""
    ordered = sorted(bands)
    usual, finer = (
        [(method, {"bands": b}) for b in ordered if (b <= USUAL) == kind for method in METHODS]
        for kind in (True, False)
    )
    return [*usual, *(("solver", {"accuracy": a}) for a in accuracies), *finer]


def shares(names: list[str], seconds: float) -> float:
    """Seconds that the first of the scenes gets of those left for all."""
    weights = [LARGE.get(name, 1.0) for name in names]
    return seconds * weights[0] / sum(weights)


def measure_scene(name: str, args, kept: dict, keep, seconds: float) -> None:
    """Measure both methods at all settings that so many seconds allow, old and new in turn."""
    scene = scenes.load(name)
    entry = kept.setdefault(name, {"title": scene.title, "origin": scene.origin, "quads": scene.quads, "measured": []})
    entry["noise"] = {m.label: 100 * m.noise for m in scene.measures}
    known = {(row["method"], json.dumps(row["setting"])) for row in entry["measured"]}
    budget = seconds / len(METHODS)
    left = dict.fromkeys(METHODS, budget)
    for method, setting in settings(args.bands, args.accuracies):
        if (method, json.dumps(setting)) in known:
            continue
        if least_seconds(entry["measured"], method, setting) > left[method]:
            row = {"failed": "left out: over the budget of seconds"}
        else:
            task = {"scene": name, "method": method, "setting": setting, "threads": args.threads}
            task |= {"most_seconds": OF_BUDGET * budget, "repeats": 1 if args.quick else REPEATS}
            row = apart.run(__file__, task, left[method])
            left[method] -= row["wall"]
        entry["measured"].append({"method": method, "setting": setting} | row)
        keep()
        print(f"{name:18}{method:11}{json.dumps(setting):20}{summary(row)}", flush=True)


def least_seconds(rows: list[dict], method: str, setting: dict) -> float:
    """Seconds that a setting takes at least, by what one run of coarser ones took: in proportion, or endless where they
    failed. Starting and reading the values at places count as well. An accuracy takes a trial on a few bands at least.
    """
    ((kind, value),) = setting.items()
    found = 0.0
    for row in rows:
        if row["method"] != method:
            continue
        ((other, coarser),) = row["setting"].items()
        if other != kind:
            coarse, finer = kind == "accuracy" and coarser <= TRIAL_BANDS, 1.0
        else:
            finer = value / coarser if kind == "bands" else coarser / value
            coarse = finer > 1
        if coarse:
            once = row["wall"] - row["seconds"] * (row["runs"] - 1) if "seconds" in row else float("inf")
            found = max(found, once * finer)
    return found


def summary(row: dict) -> str:
    """One line of what came out."""
    if "failed" in row:
        return row["failed"]
    found = ", ".join(f"{e['rms']:.3f}" for e in row["errors"].values())
    return f"{row['seconds']:8.2f} s  {row['peak_gb']:.2f} GB  RMS {found} %"


def overall(row: dict) -> tuple[float, float]:
    """RMS and largest error over all values of all lights, in percent."""
    found = row["errors"].values()
    count = sum(e["values"] for e in found)
    return (sum(e["rms"] ** 2 * e["values"] for e in found) / count) ** 0.5, max(abs(e["largest"]) for e in found)


def label(setting: dict) -> str:
    """A setting in words."""
    return f"{setting['bands']} bands" if "bands" in setting else f"accuracy {100 * setting['accuracy']:g} %"


def in_order(rows: list[dict]) -> list[dict]:
    """Bands rising, then accuracies falling."""
    return sorted(rows, key=lambda r: (r["setting"].get("bands", 10_000), -r["setting"].get("accuracy", 0)))


def summary_table(kept: dict, bands: int) -> list[str]:
    """Both methods at one number of bands, a line for each scene."""
    out = [
        f"| scene, at {bands} bands | polygons | published: s | RMS % | largest % "
        "| solver: s | RMS % | largest % | errors, ratio |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for name, entry in kept.items():
        cells, rms = [], []
        for method in METHODS:
            row = next(
                (r for r in entry["measured"] if r["method"] == method and r["setting"] == {"bands": bands}), None
            )
            if row is None or "failed" in row:
                cells += ["–", "–", "–"]
            else:
                total, largest = overall(row)
                rms.append(total)
                cells += [f"{row['seconds']:.2f}", percent(total), percent(largest)]
        ratio = f"{rms[0] / rms[1]:.0f}" if len(rms) == 2 and rms[1] > 1e-4 else "–"
        out.append(f"| [{name}](#{name.replace('_', '-')}) | {entry['quads']} | {' | '.join(cells)} | {ratio} |")
    return out


def scene_tables(name: str, entry: dict, bands: int) -> list[str]:
    """All settings of a scene, and its lights one by one at ``bands`` bands."""
    rows = in_order(entry["measured"])
    out = [
        f"### {name.replace('_', '-')}",
        "",
        f"{entry['title']}; {entry['quads']} polygons.",
        f"Reference: {entry['origin']}.",
        "",
    ]
    out += [
        "| method | setting | faces | seconds | runs | memory GB | RMS % | largest % |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for method in METHODS:
        for row in rows:
            if row["method"] != method:
                continue
            if "failed" in row:
                out.append(f"| {method} | {label(row['setting'])} | {row['failed']} | | | | | |")
                continue
            total, largest = overall(row)
            cells = f"{row['faces']:,} | {row['seconds']:.2f} | {row['runs']} | {row['peak_gb']:.2f}"
            out.append(f"| {method} | {label(row['setting'])} | {cells} | {percent(total)} | {percent(largest)} |")
    out += [
        "",
        f"| light, at {bands} bands | values | reference's own noise % "
        "| published: RMS % | mean % | solver: RMS % | mean % | stated % | places within it % |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    at = {r["method"]: r for r in rows if r["setting"] == {"bands": bands} and "failed" not in r}
    for light, noise in entry["noise"].items():
        count = next((str(r["errors"][light]["values"]) for r in at.values()), "–")
        cells = []
        for method in METHODS:
            found = at[method]["errors"][light] if method in at else None
            cells += ["–", "–"] if found is None else [percent(found["rms"]), f"{found['mean']:+.2f}"]
        told = at["solver"]["errors"][light] if "solver" in at else {}
        cells += [percent(told["stated"]), f"{told['within']:.0f}"] if "stated" in told else ["–", "–"]
        out.append(f"| {light} | {count} | {percent(noise) if noise else '0'} | {' | '.join(cells)} |")
    return [*out, ""]


def page(state: dict, picture: str) -> str:
    """What was measured, in Markdown."""
    kept, about = state["scenes"], state["about"]
    used = {r["setting"]["bands"] for e in kept.values() for r in e["measured"] if "bands" in r["setting"]}
    bands = 60 if 60 in used else max(used)
    lines = [
        "## Measured",
        "",
        f"{apart.about_line(about)} All within {about['minutes']:g} minutes: what did not fit is left out.",
        "",
        *summary_table(kept, bands),
        "",
        f"![Error against seconds, both axes logarithmic]({picture})",
        "",
    ]
    for name, entry in kept.items():
        lines += scene_tables(name, entry, bands)
    return "\n".join(lines).rstrip() + "\n"


def draw(state: dict, path: Path) -> None:
    """Error against seconds, both logarithmic, a small plot for each scene."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    kept = state["scenes"]
    columns = min(3, len(kept))
    lines = -(-len(kept) // columns)
    figure, axes = plt.subplots(
        lines, columns, figsize=(4.4 * columns, 3.7 * lines), squeeze=False, layout="constrained"
    )
    style = {"published": ("tab:orange", "o"), "solver": ("tab:blue", "s")}
    for ax, (name, entry) in zip(axes.flat, kept.items(), strict=False):
        for method, title in METHODS.items():
            colour, marker = style[method]
            rows = [r for r in in_order(entry["measured"]) if r["method"] == method and "failed" not in r]
            for by, fill in (("bands", colour), ("accuracy", "none")):
                some = [r for r in rows if by in r["setting"]]
                if not some:
                    continue
                x, y = [r["seconds"] for r in some], [max(overall(r)[0], 1e-4) for r in some]
                line = "-" if by == "bands" else ":"
                what = title if by == "bands" else f"{title}, by accuracy"
                ax.loglog(x, y, line, color=colour, marker=marker, markerfacecolor=fill, markersize=5, label=what)
                for place, row in zip(zip(x, y, strict=True), some, strict=True):
                    text = f"{row['setting'][by]:g}"
                    ax.annotate(text, place, xytext=(3, 4), textcoords="offset points", fontsize=7, color=colour)
        counts = [r["errors"] for r in entry["measured"] if "errors" in r]
        if counts and any(entry["noise"].values()):
            share = {k: e["values"] for k, e in counts[0].items()}
            noise = (sum(entry["noise"][k] ** 2 * n for k, n in share.items()) / sum(share.values())) ** 0.5
            ax.axhline(noise, color="grey", linestyle="--", linewidth=0.8, label="noise of the reference")
        for limits, set_limits in ((ax.get_xlim(), ax.set_xlim), (ax.get_ylim(), ax.set_ylim)):
            low, high = np.log10(limits) if ax.lines else (0, 1)
            set_limits(10.0 ** np.floor(low), 10.0 ** np.ceil(high))
        ax.set_title(name.replace("_", " "), fontsize=10)
        ax.grid(True, which="both", linewidth=0.3, alpha=0.5)
        ax.set_xlabel("seconds", fontsize=8)
        ax.set_ylabel("RMS error %", fontsize=8)
        ax.tick_params(labelsize=7)
    for ax in list(axes.flat)[len(kept) :]:
        ax.axis("off")
    handles = {t: h for ax in axes.flat for h, t in zip(*ax.get_legend_handles_labels(), strict=True)}
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=4, fontsize=9, frameon=False)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def write_docs(state: dict, docs: Path) -> None:
    """Put picture and tables into docs/, below what was written there by hand."""
    draw(state, docs / "images" / "time_and_error.png")
    apart.into_docs(docs / "time-and-error.md", MARK, "Time and error", page(state, "images/time_and_error.png"))


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("--quick", action="store_true", help="8 bands, one run each: only to see that it runs")
    ap.add_argument("--scenes", nargs="+", choices=scenes.NAMES, default=list(scenes.NAMES))
    ap.add_argument("--bands", nargs="+", type=int, default=list(BANDS))
    ap.add_argument("--accuracies", nargs="*", type=float, default=list(ACCURACIES))
    ap.add_argument("--minutes", type=float, default=10.0, help="budget for all scenes together")
    ap.add_argument("--threads", type=int, default=os.cpu_count() or 1)
    ap.add_argument("--output", type=Path, default=ROOT / "build" / "time_and_error")
    ap.add_argument("--fresh", action="store_true", help="measure again what was measured at this commit")
    ap.add_argument("--docs", action="store_true", help="write docs/time-and-error.md and its picture")
    ap.add_argument("--one", help=argparse.SUPPRESS)
    args = ap.parse_args()
    if args.one:
        task = json.loads(args.one)
        print(json.dumps(run_here(task.pop("scene"), **task)))
        return
    if args.quick:
        args.bands, args.accuracies = [8], []
    args.output.mkdir(parents=True, exist_ok=True)
    path = args.output / "measurements.json"
    state = {"about": apart.about(args.threads) | {"minutes": args.minutes}, "scenes": {}}
    if not args.fresh:
        state["scenes"] = apart.kept_before(path, state["about"]).get("scenes", {})

    def keep() -> None:
        path.write_text(json.dumps(state, indent=1) + "\n", encoding="utf-8")

    end = time.perf_counter() + 60 * args.minutes
    for k, name in enumerate(args.scenes):
        measure_scene(name, args, state["scenes"], keep, shares(args.scenes[k:], end - time.perf_counter()))
    state["scenes"] = {name: state["scenes"][name] for name in scenes.NAMES if name in state["scenes"]}
    keep()
    draw(state, args.output / "time_and_error.png")
    (args.output / "time-and-error.md").write_text(
        f"# Time and error\n\n{page(state, 'time_and_error.png')}", encoding="utf-8"
    )
    if args.docs:
        write_docs(state, ROOT / "docs")
    print(f"\n{args.output / 'time-and-error.md'}")


if __name__ == "__main__":
    main()
