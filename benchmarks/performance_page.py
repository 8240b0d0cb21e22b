"""The page and the picture of the performance benchmark."""

from __future__ import annotations

from pathlib import Path

import apart
import numpy as np
import solver_side
from apart import percent

MARK = "<!-- From here on written by benchmarks/performance.py -->"

AXES = {
    "faces": ("faces", "the mirror-shelf room in finer and finer faces"),
    "bands": ("bands", "bands of the globe; parcels go with their square"),
    "planes": ("outlines", "boxes of 0.3 m hung in the room, six planes each"),
    "facets": ("facets", "a ball of 1.2 m hung in the room, of more and more facets that all receive"),
    "mirrors": ("mirrors", "the shelf cut into strips, each a mirror in a plane of its own"),
    "depth": ("reflections", "mirrors of 0.9 face each other, `specular_cutoff` ends chains after so many"),
}


AIMED = 1.0
"""RMS error at which both engines are compared, foretold where it was not reached [%]."""


def seconds(value: float) -> str:
    """Seconds with three digits or so."""
    return f"{value:.0f}" if value >= 100 else f"{value:.2f}" if value >= 1 else f"{value:.3f}"


def summary(row: dict) -> str:
    """One line of what came out."""
    words = [f"{seconds(row[key])} s" for key in ("seconds", "with", "without") if key in row]
    words += [f"{row['peak_gb']:.2f} GB"] if "peak_gb" in row else []
    words += [f"RMS {percent(row['rms'])} %"] if "rms" in row else []
    words += [f"change {row['change']:.1e}"] if "change" in row else []
    return ", ".join(words) or f"{len(row.get('rows', []))} rows"


def table(head: str, rows: list[list[str]]) -> list[str]:
    """A table in Markdown; short rows are filled up."""
    columns = head.count("|") + 1
    lines = [f"| {head} |", "|" + "---|" * columns]
    return [*lines, *("| " + " | ".join(row + [""] * (columns - len(row))) + " |" for row in rows), ""]


def stages_text(part: dict) -> list[str]:
    """The room from arrays to lux."""
    whole, first, rows = part["whole"], part["first"], []
    if "failed" in whole:
        return [f"Not measured: {whole['failed']}.", ""]
    rows.append(
        ["**arrays in → lux out**", f"**{seconds(whole['seconds'])}**", str(whole["runs"]), f"{whole['peak_gb']:.2f}"]
    )
    rows += [[f"– {name}", seconds(value)] for name, value in whole["stages"].items()]
    if "failed" not in first:
        more = first["first"] - first["seconds"]
        rows.append(["the first time in a process takes longer by", seconds(max(more, 0.0)), "1"])
        rows.append(["`import luzespecular`, over NumPy's own", seconds(first["import"]), str(first["imports"])])
    for name, row in part["reuse"].items():
        if "failed" in row:
            rows.append([name, row["failed"]])
        else:
            rows.append([name, seconds(row["seconds"]), str(row["runs"]), f"{row['peak_gb']:.2f}"])
    skipped = [f"*{name}*: {why}" for name, why in whole["skipped"].items()]
    return [
        f"{whole['faces']:,} faces, {whole['receivers']:,} receivers; {whole['parcels']:,} parcels all round, looked "
        f"at by {whole['beams']:,} beams. Memory is the most "
        "that the process ever held; from *another hour* on, of a process that loaded the transfer from a file. A "
        "year is 8,760 hours, each with its sky and Sun.",
        "",
        *table("what | seconds | runs | memory GB", rows),
        "Skipped in this room: " + "; ".join(skipped) + "." if skipped else "",
        "",
    ]


def model_text(part: dict) -> list[str]:
    """Predicted and measured seconds of the steps."""
    if "failed" in part:
        return [f"Not measured: {part['failed']}.", ""]
    rows, speed, counts = [], part["rates"], part["counts"]
    for row in part["rows"]:
        cells = (
            [row["name"], f"`{row['where']}`"] if "." in row["where"] and " " not in row["where"] else [row["name"], ""]
        )
        if "predicted" in row:
            cells += [f"{row['bytes'] / 1e6:,.0f}", f"{row['picks'] / 1e6:.1f}", seconds(row["predicted"])]
            share = f"{row['measured'] / row['predicted']:.1f}" if row["predicted"] > 0 else "–"
        else:
            cells += ["–", "–", "–"]
            share = "–"
        rows.append([*cells, seconds(row["measured"]), share])
    known = [row for row in part["rows"] if "predicted" in row]
    total, foretold = sum(row["measured"] for row in part["rows"]), sum(row["predicted"] for row in known)
    told = sum(row["measured"] for row in known)
    byte_sum, picks = sum(row["bytes"] for row in known), sum(row["picks"] for row in known)
    rows.append(
        [
            "**all**",
            "",
            f"{byte_sum / 1e6:,.0f}",
            f"{picks / 1e6:.1f}",
            seconds(foretold),
            seconds(total),
            f"{told / max(foretold, 1e-12):.1f}",
        ]
    )
    each = ", ".join(f"{value / 1e6:.2f} million {name}" for name, value in counts.items() if name != "outlines")
    return [
        f"{part['groups']} of {part['of']} groups, {part['receivers']:,} receivers, one thread: {each}.",
        "",
        *table("step | function | MB passed | million picks | predicted s | measured s | measured / predicted", rows),
        f"Rates of one thread, arrays of {speed['cells']:,} float32 [GB/s]: copy {speed['copy_cache'] / 1e9:.0f}, add "
        f"{speed['add_cache'] / 1e9:.0f}, add into a new array {speed['fresh_cache'] / 1e9:.0f}; arrays of 64 MB: copy "
        f"{speed['copy_memory'] / 1e9:.0f}, add {speed['add_memory'] / 1e9:.0f}, add into a new array "
        f"{speed['fresh_memory'] / 1e9:.0f}. Picks: {speed['picks'] / 1e6:,.0f} million a second.",
        "",
        *table(
            "floor that bandwidth sets | seconds",
            [
                ["these passes, all in place, no picks", f"{part['floor_passes']:.4f}"],
                ["each parcel's surface and distance written once and read once", f"{part['floor_cache']:.4f}"],
                ["the rows of form factors written to memory once", f"{part['floor_memory']:.4f}"],
                ["measured", f"{total:.4f}"],
            ],
        ),
    ]


def embree_text(part: dict, engines: dict) -> list[str]:
    """Directions per second."""
    if "failed" in part:
        return [f"Not measured: {part['failed']}.", ""]
    rows = [
        [row["what"], f"{row['directions'] / 1e6:.2f}", seconds(row["seconds"]), f"**{row['rate'] / 1e6:.1f}**"]
        for row in part["rows"]
    ]
    rates = {row["what"]: row["rate"] for row in part["rows"]}
    if "Embree" in rates:
        alone, all_ = (rates[name] / rates["Embree"] for name in ("nearest surface alone", "visibility"))
        last = [
            f"Asked the same, the solver answers at {alone:.2f} times Embree's rate (embreex {engines['embreex']}), "
            f"{100 * part['agree_rays']:.3f} % of the answers alike. With what edges leave of parcels: "
            f"{all_:.2f} times Embree's rate; of parcels that no edge crosses, {100 * part['agree']:.3f} % show the "
            "outline that Embree's ray meets.",
            "",
        ]
    else:
        last = ['Embree is not installed: `python -m pip install -e ".[engines]"`.', ""]
    return [
        f"{part['receivers']:,} receivers × all {part['parcels']:,} parcels above their horizon; {part['triangles']} "
        f"triangles; medians of {part['runs']}.",
        "",
        *table("what | million directions | seconds | million a second", rows),
        *last,
    ]


def skips_text(part: dict) -> list[str]:
    """With each skip and without it."""
    rows = []
    for name, row in part.items():
        if "failed" in row:
            rows.append([name, row["failed"]])
            continue
        change = "0" if row["change"] == 0 else f"{row['change']:.1e} ({row['median_change']:.1e})"
        saved = f"{100 * (1 - row['with'] / row['without']):+.0f}"
        rows.append([name, row["note"], seconds(row["with"]), seconds(row["without"]), saved, change, str(row["runs"])])
    return table(
        "skipped | what was run | with: CPU s | without: CPU s | saved % | change: largest (median) | runs", rows
    )


def growth_text(part: dict) -> list[str]:
    """Tables with the slopes."""
    out, slopes = [], []
    for kind, rows in part.items():
        axis, what = AXES[kind]
        done = [row for row in rows if "failed" not in row]
        lines = [
            [
                f"{row['x']:,.0f}",
                f"{row['faces']:,}",
                f"{row['receivers']:,}",
                seconds(row["prepare"]),
                seconds(row["solve"]),
                f"{row['peak_gb']:.2f}",
                str(row["runs"]),
            ]
            for row in done
        ]
        lines += [[f"next: {row['failed']}"] for row in rows if "failed" in row]
        out += [f"**{axis}**: {what}.", ""]
        out += table(f"{axis} | faces | receivers | prepare s | solve s | memory GB | runs", lines)
        x = [row["x"] for row in done]
        if len(x) > 1:
            each = [slope_text(x, [row[key] for row in done]) for key in ("prepare", "solve", "seconds", "peak_gb")]
            ends = solver_side.slope(x[-2:], [row["seconds"] for row in done[-2:]])
            slopes.append([axis, f"{x[0]:,.0f} to {x[-1]:,.0f}", *each, f"{2**ends:.2f}"])
    head = "what grows | from … to | prepare | solve | both | memory | doubling costs, at the end"
    return ["Slopes in log–log, by least squares:", "", *table(head, slopes), *out]


def slope_text(x: list[float], y: list[float]) -> str:
    """A slope with two decimals."""
    return f"{solver_side.slope(x, y):.2f}"


def radiance_text(part: dict, engines: dict) -> list[str]:
    """Seconds beside errors."""
    rows = []
    solver = [row for row in part["solver"] if "failed" not in row]
    for engine in ("solver", "radiance"):
        for row in part[engine]:
            cells = [
                engine if engine == "solver" else "Radiance",
                f"`{row['label']}`" if engine == "radiance" else row["label"],
            ]
            if "failed" in row:
                rows.append([*cells, row["failed"]])
                continue
            cells += [f"{row['faces']:,}", seconds(row["seconds"]), f"{row['peak_gb']:.2f}"]
            cells += [percent(row[key]) for key in ("rms", "of_mean", "median", "largest")] + [f"{row['mean']:+.2f}"]
            rows.append([*cells, ratio_text(row, solver) if engine == "radiance" else ""])
    head = "engine | setting | points | seconds | memory GB | RMS % | RMS, of mean % | median % | largest % | mean %"
    out = table(f"{head} | solver is faster by", rows)
    out += [f"Errors hold the reference's own noise of {percent(part['noise'])} % RMS.", ""]
    if not part["installed"]:
        return [*out, 'Radiance is not installed: `python -m pip install -e ".[engines]"`.', ""]
    plain = [row for row in part["radiance"] if "failed" not in row and not row["cache"]]
    ours = [row for row in solver if row["rms"] <= AIMED]
    if plain and ours:
        best, fastest = plain[-1], min(row["seconds"] for row in ours)
        needed = best["seconds"] * (best["rms"] / AIMED) ** 2
        out += [
            f"pyradiance {engines['pyradiance']}. Without its cache, chance makes Radiance's error fall with the square"
            " root of its seconds, and what it cuts off does not fall with more samples at all: from its last such line"
            f" on, {AIMED:g} % would take {needed:,.0f} s or more, {needed / fastest:,.0f} times the "
            f"{seconds(fastest)} s of the solver's quickest setting that errs no more.",
            "",
        ]
    return out


def ratio_text(row: dict, solver: list[dict]) -> str:
    """How many times faster the solver's quickest setting is that errs no more."""
    found = [ours["seconds"] for ours in solver if ours["rms"] <= row["rms"]]
    return f"{row['seconds'] / min(found):,.1f} ×" if found else "–"


def page(state: dict, picture: str) -> str:
    """What was measured, in Markdown."""
    about = state["about"]
    engines = about["engines"]
    sections = {
        "stages": ("The light-shelf room, stage by stage", stages_text),
        "model": ("The cost model: predicted and measured", model_text),
        "embree": ("Beside Embree", lambda part: embree_text(part, engines)),
        "radiance": ("Beside Radiance", lambda part: radiance_text(part, engines)),
        "skips": ("What each skip saves", skips_text),
        "growth": ("Growth", growth_text),
    }
    lines = ["## Measured", "", f"{apart.about_line(about)} All within {about['minutes']:g} minutes.", ""]
    lines += [f"![Growth, skips, rates, error against seconds, cost model]({picture})", ""]
    for name, (title, text) in sections.items():
        lines += [f"### {title}", "", *(text(state[name]) if name in state else ["Not measured.", ""])]
    return "\n".join(lines).rstrip() + "\n"


def draw(state: dict, path: Path) -> None:
    """Six small plots."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(2, 3, figsize=(14, 8), layout="constrained")
    _draw_growth(axes[0, 0], state.get("growth", {}), "seconds", "seconds, prepare and solve")
    _draw_growth(axes[0, 1], state.get("growth", {}), "peak_gb", "peak memory [GB]")
    _draw_radiance(axes[0, 2], state.get("radiance", {"solver": [], "radiance": [], "noise": 0}))
    rows = state.get("model", {}).get("rows", [])
    names = [row["name"] for row in rows]
    axes[1, 0].barh(names, [row["measured"] for row in rows], color="tab:blue", label="measured", height=0.8)
    axes[1, 0].barh(names, [row.get("predicted", 0) for row in rows], color="tab:orange", label="predicted", height=0.4)
    axes[1, 0].set_title("hot path, seconds of one thread", fontsize=10)
    rows = state.get("embree", {}).get("rows", [])
    axes[1, 1].barh([row["what"] for row in rows], [row["rate"] / 1e6 for row in rows], color="tab:green")
    axes[1, 1].set_title("million directions a second", fontsize=10)
    skips = {name: row for name, row in state.get("skips", {}).items() if "failed" not in row}
    shares = [100 * (1 - row["with"] / row["without"]) for row in skips.values()]
    axes[1, 2].barh(list(skips), shares, color="tab:purple")
    axes[1, 2].set_title("seconds that skips save [%]", fontsize=10)
    for ax in axes[1]:
        ax.invert_yaxis()
        ax.tick_params(labelsize=7)
        ax.grid(True, axis="x", linewidth=0.3, alpha=0.5)
    for ax in (axes[0, 0], axes[0, 2], axes[1, 0]):
        if ax.get_legend_handles_labels()[0]:
            ax.legend(fontsize=7)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def _draw_growth(ax, part: dict, key: str, title: str) -> None:
    """Relative sizes on the horizontal axis, so that all that grows fits into one plot."""
    for kind, rows in part.items():
        done = [row for row in rows if "failed" not in row]
        if done:
            sizes = [row["x"] / done[0]["x"] for row in done]
            ax.loglog(sizes, [row[key] for row in done], marker="o", markersize=4, label=AXES[kind][0])
    ax.set_title(title, fontsize=10)
    ax.set_xlabel("times as many as at first", fontsize=8)
    _whole_decades(ax)
    ax.grid(True, which="both", linewidth=0.3, alpha=0.5)


def _whole_decades(ax) -> None:
    """A vertical axis that begins and ends at powers of ten, if anything is drawn."""
    if ax.lines:
        low, high = np.log10(ax.get_ylim())
        ax.set_ylim(10.0 ** np.floor(low), 10.0 ** np.ceil(high))
    ax.tick_params(which="both", labelsize=7)


def _draw_radiance(ax, part: dict) -> None:
    kinds = (
        ("LuzEspecular", "solver", None, "tab:blue", "s"),
        ("Radiance", "radiance", False, "tab:orange", "o"),
        ("Radiance, with its cache", "radiance", True, "tab:red", "^"),
    )
    for title, engine, cache, colour, marker in kinds:
        rows = [row for row in part[engine] if "failed" not in row and row.get("cache") == cache]
        if rows:
            x, y = [row["seconds"] for row in rows], [row["rms"] for row in rows]
            ax.loglog(x, y, color=colour, marker=marker, markersize=5, label=title)
    if part["noise"]:
        ax.axhline(part["noise"], color="grey", linestyle="--", linewidth=0.8, label="noise of the reference")
    ax.set_title("RMS error [%] against seconds", fontsize=10)
    _whole_decades(ax)
    ax.grid(True, which="both", linewidth=0.3, alpha=0.5)


def write_docs(state: dict, docs: Path) -> None:
    """Put picture and tables into docs/, below what was written there by hand."""
    draw(state, docs / "images" / "performance.png")
    apart.into_docs(docs / "performance.md", MARK, "Performance", page(state, "images/performance.png"))
