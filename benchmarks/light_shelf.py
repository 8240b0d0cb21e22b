"""Run time and error of the light-shelf room, beside each other.

    python benchmarks/light_shelf.py [--repeats 3] [--bands 60] [--max-area 0.005] [--threads N]

For each variant: seconds to prepare (median) and for another hour on the same geometry, peak memory, and the error
against independent path tracing (``tests/data/ref_light_shelf.json``): of the surface means, and over the places of all
surfaces.
"""

import argparse
import json
import platform
import statistics
import time

import apart
import numpy as np
from apart import ROOT
from rooms import light_shelf_room

import luzespecular as luz

SKIES = {"overcast": ("overcast", False), "clear_12": ("clear", False), "sun_12": (None, True)}


def errors(result, reference, light):
    """Errors of surface means, and RMS error over all places, in percent."""
    expected = reference["lux"][light]
    means, all_places = {}, []
    for name, lux in expected.items():
        points = np.array(reference["points"][name])
        got = result.at(points, np.broadcast_to(reference["normals"][name], points.shape))
        total = np.array(lux["total"])
        means[name] = 100 * (got.mean() / total.mean() - 1)
        all_places.append(got / total - 1)
    return means, 100 * float(np.sqrt(np.mean(np.concatenate(all_places) ** 2)))


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("--repeats", type=int, default=3)
    ap.add_argument("--bands", type=int, default=60)
    ap.add_argument("--max-area", type=float, default=0.005)
    ap.add_argument("--threads", type=int)
    ap.add_argument("--variants", default="D,S1,S2")
    args = ap.parse_args()
    room = light_shelf_room()
    reference = json.loads((ROOT / "tests" / "data" / "ref_light_shelf.json").read_text())
    print(f"Python {platform.python_version()}, NumPy {np.__version__}, {platform.machine()}")
    print(f"bands {args.bands}, max_area {args.max_area} m², medians of {args.repeats}\n")
    print("| variant | faces | prepare s | another hour s | light | surface means: largest error % | places: RMS % |")
    print("|---|---|---|---|---|---|---|")
    for variant in args.variants.split(","):
        options = {"bands": args.bands, "max_area": args.max_area, "threads": args.threads}
        prepared = []
        for _ in range(args.repeats):
            start = time.perf_counter()
            transfer = luz.prepare(room.scene(variant), **options)
            prepared.append(time.perf_counter() - start)
        hours = []
        for hour in (9.0, 10.0, 12.0):
            light = room.daylight(hour)
            start = time.perf_counter()
            result = transfer.solve(light)
            hours.append(time.perf_counter() - start)
        head = f"| {variant} | {len(result.areas)} | {statistics.median(prepared):.2f} | {statistics.median(hours):.2f}"
        for name, (sky, sun) in SKIES.items():
            solved = transfer.solve(room.daylight(12.0, sky=sky, sun=sun), tolerance=1e-6)
            means, rms = errors(solved, reference, f"{variant}_{name}")
            worst = max(means, key=lambda k: abs(means[k]))
            print(f"{head} | {name} | {means[worst]:+.2f} ({worst}) | {rms:.2f} |")
            head = "| | | |"
    print(f"\npeak memory of the whole run: {apart.peak_gb():.2f} GB")


if __name__ == "__main__":
    main()
