"""Parallel work: receivers in chunks, progress, errors, and stopping at once."""

import threading
import time

import numpy as np
import pytest
from builders import box, prepare_coarse

import luzespecular as luz
from luzespecular.parallel import chunks_of_receivers, run_parallel
from luzespecular.planes import find_planes

WHITE = luz.Material(diffuse_reflectance=0.5)


def room():
    """An open room with a mirror and a screen: every stage has work."""
    scene = box(WHITE, (3, 2, 2.5), without=("north",), ceiling=luz.Material(specular_reflectance=0.8))
    scene.add("screen", [[1, 1, 0], [2, 1, 0], [2, 1, 1.5], [1, 1, 1.5]], WHITE, two_sided=True)
    return scene


def test_chunks_share_out_the_receivers_plane_by_plane():
    transfer = prepare_coarse(room(), elements=2000)
    nodes, planes = transfer.nodes, transfer.geometry.planes
    chunks = chunks_of_receivers(nodes.points, nodes.sheet, planes, 500)
    np.testing.assert_array_equal(np.sort(np.concatenate(chunks)), np.arange(len(nodes.points)))
    assert len(chunks) > len(planes.sheet_surface)
    for chunk in chunks:
        assert len(np.unique(nodes.sheet[chunk])) == 1


def test_receivers_of_a_chunk_lie_near_each_other():
    planes = find_planes(box(WHITE, (3, 2, 2.5)))
    rng = np.random.default_rng(5)
    points = np.c_[rng.uniform(-1.5, 1.5, 4000), rng.uniform(-1, 1, 4000), np.full(4000, -1.25)]
    chunks = chunks_of_receivers(points, np.zeros(4000, int), planes, 100)
    assert max(len(chunk) for chunk in chunks) <= 100 and len(chunks) == 40
    extent = np.median([np.ptp(points[chunk], axis=0)[:2].max() for chunk in chunks])
    assert extent < 1.2, "a quarter of the floor at most, not strips all along it"


def test_receivers_in_a_row_or_in_one_place():
    planes = find_planes(box(WHITE))
    row = np.c_[np.linspace(-0.5, 0.5, 50), np.zeros(50), np.full(50, -0.5)]
    for points in (row, np.zeros((50, 3)) - [0, 0, 0.5]):
        chunks = chunks_of_receivers(points, np.zeros(50, int), planes, 8)
        np.testing.assert_array_equal(np.sort(np.concatenate(chunks)), np.arange(50))
        assert max(len(chunk) for chunk in chunks) <= 8
    assert chunks_of_receivers(np.zeros((0, 3)), np.zeros(0, int), planes, 8) == []


@pytest.mark.parametrize("threads", [1, 3])
def test_every_task_is_done_once_and_told(threads):
    done, told, lock = [], [], threading.Lock()

    def work(task, checkpoint):
        checkpoint()
        with lock:
            done.append(task)

    run_parallel(work, list(range(25)), threads, told.append)
    assert sorted(done) == list(range(25))
    assert told[-1] == 1 and (np.diff(told) >= 0).all()
    run_parallel(work, [], threads, told.append)


def test_one_long_task_can_be_stopped():
    """It is asked for while it runs, not only when it is done."""
    begin = time.perf_counter()

    def work(task, checkpoint):
        while time.perf_counter() - begin < 10:
            time.sleep(0.01)
            checkpoint()

    def report(done):
        if time.perf_counter() - begin > 0.3:
            raise luz.Cancelled("enough")

    with pytest.raises(luz.Cancelled, match="enough"):
        run_parallel(work, [0], 1, report)
    assert time.perf_counter() - begin < 1.5


def test_cancelling_does_not_wait_for_the_rest():
    """Work under way stops at its next checkpoint; tasks not begun never run."""
    started = []

    def work(task, checkpoint):
        started.append(task)
        for _ in range(100):
            time.sleep(0.005)
            checkpoint()

    def stop(done):
        raise luz.Cancelled("now")

    def quick(task, checkpoint):
        if task:
            work(task, checkpoint)

    begin = time.perf_counter()
    with pytest.raises(luz.Cancelled):
        run_parallel(quick, list(range(20)), 2, stop)
    assert time.perf_counter() - begin < 0.4
    assert len(started) < 6


def test_errors_of_a_task_come_through():
    def work(task, checkpoint):
        if task == 3:
            raise ZeroDivisionError("task three")

    with pytest.raises(ZeroDivisionError, match="task three"):
        run_parallel(work, list(range(6)), 2, lambda done: None)
