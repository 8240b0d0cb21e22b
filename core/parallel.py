"""Parallel work: receivers in chunks, chunks on several threads, stopped where the user wants to."""

from __future__ import annotations

import itertools
import math
import threading
import time
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait

import numpy as np

from .errors import Cancelled
from .planes import Planes

_POLL = 0.1
"""Seconds between looks whether the user wants to stop."""


def chunks_of_receivers(points, sheet, planes: Planes, most: int) -> list[np.ndarray]:
    """Receivers of one plane that lie near each other, in chunks.

    Parameters
    ----------
    points : (m, 3) float
    sheet : (m,) int, plus the number of sheets for backs
    planes : Planes
    most : int
        Receivers in a chunk.

    Returns
    -------
    list of (k,) int arrays
    """
    fronts = len(planes.sheet_surface)
    order = np.argsort(sheet, kind="stable")
    bounds = np.flatnonzero(np.concatenate(([True], np.diff(sheet[order]) > 0, [True])))
    chunks = []
    for a, b in itertools.pairwise(bounds):
        members = order[a:b]
        parts = math.ceil(len(members) / most)
        if parts > 1:
            place = points[members] @ planes.sheet_axes[sheet[members[0]] % fronts].T
            chunks += [members[some] for some in _halved(place, np.arange(len(members)), parts)]
        elif parts == 1:
            chunks.append(members)
    return chunks


def _halved(place: np.ndarray, some: np.ndarray, parts: int) -> list[np.ndarray]:
    """Some of the places ``(k, 2)`` in so many parts, as compact and as equal as may be: halves of halves."""
    if parts == 1:
        return [some]
    along = int(np.argmax(np.ptp(place[some], axis=0)))
    some = some[np.argsort(place[some, along], kind="stable")]
    first = parts // 2
    end = len(some) * first // parts
    return _halved(place, some[:end], first) + _halved(place, some[end:], parts - first)


def run_parallel(work: Callable, tasks: list, threads: int, report: Callable[[float], None]) -> None:
    """Run ``work(task, checkpoint)`` for each task on several threads; a single task, or on one thread, in this one.

    ``report`` is called with the share of tasks done, and often enough for a user to stop a long one. Where it raises,
    tasks under way stop at their next checkpoint and the exception goes on to the caller.
    """
    if threads == 1 or len(tasks) <= 1:
        _run_here(work, tasks, report)
        return
    stop, lock, left = threading.Event(), threading.Lock(), iter(tasks)
    done = 0

    def checkpoint() -> None:
        if stop.is_set():
            raise Cancelled("Cancelled")

    def run() -> None:
        nonlocal done
        while True:
            checkpoint()
            with lock:
                try:
                    task = next(left)
                except StopIteration:
                    return
            work(task, checkpoint)
            with lock:
                done += 1

    with ThreadPoolExecutor(max_workers=threads) as pool:
        pending = {pool.submit(run) for _ in range(min(threads, len(tasks)))}
        try:
            while pending:
                finished, pending = wait(pending, timeout=_POLL, return_when=FIRST_COMPLETED)
                for future in finished:
                    future.result()
                report(done / len(tasks))
        except BaseException:
            stop.set()
            raise


def _run_here(work: Callable, tasks: list, report: Callable[[float], None]) -> None:
    done, told = 0, time.monotonic()

    def checkpoint() -> None:
        nonlocal told
        if time.monotonic() - told > _POLL:
            report(done / len(tasks))
            told = time.monotonic()

    for task in tasks:
        checkpoint()
        work(task, checkpoint)
        done += 1
    if tasks:
        report(1.0)
