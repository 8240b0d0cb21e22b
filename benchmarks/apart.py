"""Measurements in processes of their own: seconds as medians, peak memory, where and when, and a budget that is kept.

A script that measures so calls itself with ``--one`` and a task in JSON, does the task and prints what came out as
its last line.
"""

from __future__ import annotations

import datetime
import json
import os
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]


def run(script: str, task: dict, limit: float) -> dict:
    """Do a task in a process of its own.

    Parameters
    ----------
    script : str
        Path of the script that knows the task.
    task : dict
    limit : float
        Seconds after which it is stopped.

    Returns
    -------
    dict
        What the task gave; ``failed`` says why where it did not come to an end. ``wall`` are the seconds of the whole
        process.
    """
    command = [sys.executable, str(Path(script).resolve()), "--one", json.dumps(task)]
    start = time.perf_counter()
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit, check=False)
    except subprocess.TimeoutExpired:
        return {"failed": f"not done within {limit:.0f} s", "wall": time.perf_counter() - start}
    wall = {"wall": time.perf_counter() - start}
    if done.returncode:
        last = done.stderr.strip().splitlines()
        return {"failed": last[-1] if last else f"exit status {done.returncode}"} | wall
    return json.loads(done.stdout.strip().splitlines()[-1]) | wall


def peak_gb(children: bool = False) -> float:
    """Most memory that this process, or the largest of its children, ever held [GB]."""
    import resource  # not on Windows, where the rest of the benchmarks runs

    who = resource.RUSAGE_CHILDREN if children else resource.RUSAGE_SELF
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(who).ru_maxrss * unit / 1e9


def medians(
    works: dict[str, Callable[[], object]],
    repeats: int,
    most_seconds: float,
    clock: Callable[[], float] = time.perf_counter,
) -> tuple[dict, int]:
    """Run several things in turn, again and again: median seconds of each by name, and how many runs they are of.

    In turn, so that whatever else the machine does falls on all alike. It ends early where a further round would take
    more than ``most_seconds`` in all. ``clock`` may be that of this process's work on all threads.
    """
    start, found = time.perf_counter(), []
    while len(found) < repeats:
        round_began, row = time.perf_counter(), {}
        for name, work in works.items():
            begun = clock()
            work()
            row[name] = clock() - begun
        found.append(row)
        now = time.perf_counter()
        if now - start + (now - round_began) > most_seconds:
            break
    return {name: statistics.median(row[name] for row in found) for name in works}, len(found)


def about(threads: int) -> dict:
    """Where and when the measurements are made."""

    def git(*words: str) -> str:
        done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False)
        return done.stdout.strip()

    commit = git("rev-parse", "--short", "HEAD") or "unknown"
    changed = " with changes of the solver on top" if git("status", "--porcelain", "--", "core") else ""
    return {
        "date": datetime.date.today().isoformat(),
        "commit": commit + changed,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "machine": f"{platform.system()} {platform.machine()}",
        "cores": os.cpu_count(),
        "threads": threads,
        "load": round(os.getloadavg()[0], 2) if hasattr(os, "getloadavg") else None,
    }


def about_line(about: dict) -> str:
    """The same in words."""
    load = about.get("load")
    busy = "" if load is None else f"; other work before it began: {load / about['cores']:.0%} of the cores"
    return (
        f"{about['date']}, commit {about['commit']}; Python {about['python']}, NumPy {about['numpy']}, "
        f"{about['machine']}, {about['cores']} cores, {about['threads']} threads{busy}."
    )


def kept_before(path: Path, now: dict) -> dict:
    """What was measured at this commit, on this machine, with as many threads; nothing where that differs."""
    if not path.exists():
        return {}
    before = json.loads(path.read_text(encoding="utf-8"))
    same = ("commit", "threads", "numpy", "cores")
    return before if all(before["about"].get(key) == now[key] for key in same) else {}


def into_docs(path: Path, mark: str, title: str, text: str) -> None:
    """Put what was measured into a page, below what was written there by hand."""
    head = path.read_text(encoding="utf-8").split(mark)[0].rstrip() if path.exists() else f"# {title}"
    path.write_text(f"{head}\n\n{mark}\n\n{text}", encoding="utf-8")


def percent(value: float) -> str:
    """Three digits that count, no more than three decimals."""
    return f"{value:.3f}" if abs(value) < 1 else f"{value:.2f}" if abs(value) < 10 else f"{value:.0f}"
