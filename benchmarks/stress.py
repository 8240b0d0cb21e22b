"""Does it stand up to what breaks numerics? Every situation of tests/stress with what is expected and what came out.

Invariance (moved, scaled, turned, split), degenerate geometry, energy, light, scale and precision. Exit status 1 where
a situation does not come out as expected.

    python benchmarks/stress.py                  # all but the long ones, some ten minutes
    python benchmarks/stress.py --long           # the long ones as well (millions of triangles), half an hour
    python benchmarks/stress.py --only energy    # one family, or situations with this in their name

What takes longer than --limit seconds (300) is stopped and counts as not as expected.
"""

import argparse
import contextlib
import logging
import signal
import sys
import time
from collections.abc import Iterator
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1] / "tests"
# this folder goes last: its own stress.py and scenes.py are not meant here
sys.path[:0] = [str(TESTS / "stress"), str(TESTS)]

import table  # noqa: E402
from situations import holds, run  # noqa: E402


@contextlib.contextmanager
def at_most(seconds: float) -> Iterator[None]:
    """Stop what takes longer, with `TimeoutError`; where there are no alarms (Windows), it takes what it takes."""
    if not hasattr(signal, "setitimer"):
        yield
        return

    def stop(*_) -> None:
        raise TimeoutError(f"no end within {seconds:g} s")

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def main(arguments=None) -> int:
    """Print the table; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--long", action="store_true", help="the long situations as well")
    parser.add_argument("--only", default="", metavar="TEXT", help="a family, or part of situations' names")
    parser.add_argument("--limit", type=float, default=300.0, metavar="SECONDS", help="of one situation (300)")
    options = parser.parse_args(arguments)
    logging.disable(logging.WARNING)
    failed, total = [], 0
    print(f"{'family':<11}{'situation':<66}{'expected':<34}{'got':<34}{'error':>9} {'allowed':>9}{'s':>7}")
    for situation in table.situations():
        if (situation.long and not options.long) or options.only not in f"{situation.family} {situation.name}":
            continue
        start = time.perf_counter()
        try:
            with at_most(options.limit):
                outcome = run(situation)
        except TimeoutError as error:
            outcome = holds(False, "an end", str(error))
        seconds = time.perf_counter() - start
        total += 1
        if not outcome.holds:
            failed.append(situation.name)
        print(
            f"{situation.family:<11}{situation.name[:64]:<66}{outcome.expected[:32]:<34}{outcome.got[:32]:<34}"
            f"{outcome.error:>9.2g} {outcome.allowed:>9.2g}{seconds:>7.1f}{'' if outcome.holds else '  FAILED'}",
            flush=True,
        )
    print(f"{total - len(failed)} of {total} as expected" + (f"; not: {', '.join(failed)}" if failed else ""))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
