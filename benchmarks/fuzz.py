"""Random bytes into the file readers and random meshes into the scene: refusals only, no crash, no hang.

Every trial has a number; what one finds is printed with it and comes again by ``--first NUMBER --seconds 0``. What was
found so far is tested in tests/stress/test_faults.py and tests/core. Exit status 1 where something is found.

    python benchmarks/fuzz.py                 # ten minutes
    python benchmarks/fuzz.py --seconds 60 --first 1000000
"""

import argparse
import itertools
import logging
import sys
import tempfile
import time
import traceback
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1] / "tests"
sys.path[:0] = [str(TESTS / "stress"), str(TESTS)]

from fuzz import TRIALS, trial  # noqa: E402

SLOW = 5.0
"""Seconds from which a trial counts as a hang: all of them are tiny."""


def main(arguments=None) -> int:
    """Run trials until the time is up; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=600.0, help="how long (default: 600); 0 = one trial")
    parser.add_argument("--first", type=int, default=0, metavar="N", help="number of the first trial (default: 0)")
    options = parser.parse_args(arguments)
    logging.disable(logging.WARNING)
    end, found, done = time.monotonic() + options.seconds, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for number in itertools.count(options.first):
            begun = time.monotonic()
            try:
                trial(number, Path(folder))
            except Exception:  # noqa: BLE001 - whatever it is, it is what is looked for
                found += 1
                print(f"trial {number}, {TRIALS[number % len(TRIALS)].__name__}:", flush=True)
                traceback.print_exc(limit=-4, file=sys.stdout)
            done += 1
            if time.monotonic() - begun > SLOW:
                found += 1
                print(f"trial {number} took {time.monotonic() - begun:.1f} s", flush=True)
            if time.monotonic() >= end:
                break
    print(f"{done} trials from {options.first} on, {found} found something")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
