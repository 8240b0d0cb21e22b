"""What the console command and Blender's headless command share: hours and dates read, progress and tables printed."""

from __future__ import annotations

import argparse
import datetime as dt
import sys
from collections.abc import Callable, Sequence

from .tables import SurfaceStatistics


class Progress:
    """Progress on the terminal: one line written over, or a line for every tenth where that goes to a file."""

    def __init__(self):
        self._terminal = sys.stderr.isatty()
        self._told = -1

    def __call__(self, fraction: float, stage: str) -> bool:
        """Tell how far the run is; go on."""
        percent = int(100.0 * fraction)
        step = percent if self._terminal else percent // 10
        if step != self._told:
            self._told = step
            text = f"{percent:3d} %  {stage}"
            print(
                f"\r{text:<60}" if self._terminal else text,
                end="" if self._terminal else "\n",
                file=sys.stderr,
                flush=True,
            )
        return True

    def end(self) -> None:
        """Finish the line."""
        if self._terminal and self._told >= 0:
            print(file=sys.stderr)


def print_statistics(title: str, rows: Sequence[SurfaceStatistics]) -> None:
    """Print lux per surface."""
    names = [row.name if row.side == "front" else f"{row.name} (back)" for row in rows]
    width = max([len(name) for name in names], default=0)
    print(f"\n{title}")
    print(f"{'':<{width}} {'minimum':>10} {'mean':>10} {'maximum':>10} {'uniformity':>11}   [lx]")
    for name, row in zip(names, rows, strict=True):
        total = row.total
        print(
            f"{name:<{width}} {total.minimum:10.1f} {total.mean:10.1f} {total.maximum:10.1f} {total.uniformity:11.3f}"
        )


def clock(hour: float) -> str:
    """Return an hour of the day as hh:mm."""
    minutes = round(hour * 60.0)
    return f"{minutes // 60:02d}:{minutes % 60:02d}"


def hours_of_day(text: str) -> list[float]:
    """Read hours from a command line: 9, 10.5 or 12:15, with commas between."""
    hours = []
    for part in text.split(","):
        try:
            whole, _, minutes = part.strip().partition(":")
            hour = float(whole) + (float(minutes) / 60.0 if minutes else 0.0)
        except ValueError:
            raise argparse.ArgumentTypeError(f"'{part}' is no hour: write 9, 10.5 or 12:15") from None
        if not 0.0 <= hour <= 24.0:
            raise argparse.ArgumentTypeError(f"'{part}' is no hour of a day: give 0 to 24")
        hours.append(hour)
    return hours


def iso_date(text: str) -> dt.date:
    """Read a date from a command line."""
    try:
        return dt.date.fromisoformat(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is no date: write it as 2026-06-22") from None


def formats_of(*known: str) -> Callable[[str], tuple[str, ...]]:
    """Return a reader of file formats from a command line, with commas between, that knows the given ones."""

    def read(text: str) -> tuple[str, ...]:
        formats = tuple(part.strip().lower() for part in text.split(","))
        unknown = [part for part in formats if part not in known]
        if unknown:
            raise argparse.ArgumentTypeError(f"'{unknown[0]}' is no format: choose from {', '.join(known)}")
        return formats

    return read
