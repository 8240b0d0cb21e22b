"""The benchmark still runs, in its smallest setting; its references are what they say. No timings are asserted."""

import argparse
import importlib.util
import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import luzespecular as luz

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"


@pytest.fixture(scope="module")
def rooms():
    """The benchmark's modules by name, as its own folder's scripts import one another."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(BENCHMARKS))
        loaded = {}
        for name in ("scenes", "hit_or_miss", "brute_force", "apart", "time_and_error"):
            spec = importlib.util.spec_from_file_location(name, BENCHMARKS / f"{name}.py")
            loaded[name] = importlib.util.module_from_spec(spec)
            patch.setitem(sys.modules, name, loaded[name])
            spec.loader.exec_module(loaded[name])
        yield loaded


def test_runs_and_writes_errors_of_both_methods(tmp_path):
    command = [sys.executable, BENCHMARKS / "time_and_error.py", "--quick", "--threads", "1", "--output", tmp_path]
    chosen = ["white_box", "light_pipe"]
    done = subprocess.run([*command, "--scenes", *chosen], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    state = json.loads((tmp_path / "measurements.json").read_text(encoding="utf-8"))
    assert sorted(state["scenes"]) == sorted(chosen)
    for entry in state["scenes"].values():
        measured = [row for row in entry["measured"] if "bands" in row["setting"]]
        assert [row["method"] for row in measured] == ["published", "solver"]
        for row in measured:
            found = [e[key] for e in row["errors"].values() for key in ("rms", "largest", "mean")]
            assert np.isfinite(found).all() and row["seconds"] > 0
    page = (tmp_path / "time-and-error.md").read_text(encoding="utf-8")
    assert "| solver | 8 bands |" in page and "| published | 8 bands |" in page
    assert (tmp_path / "time_and_error.png").stat().st_size > 10_000

    again = subprocess.run([*command, "--scenes", *chosen], capture_output=True, text=True, timeout=60, check=False)
    assert again.returncode == 0 and " s " not in again.stdout  # what is measured stays


def test_what_would_not_fit_is_left_out(rooms, monkeypatch):
    """A run ends within its minutes: finer settings are foretold from coarser ones, the rest is one scene's share."""
    tool, asked = rooms["time_and_error"], []

    def measured(script, task, limit):
        asked.append((task["method"], *task["setting"].items(), limit))
        if task["method"] == "published" or task["scene"] == "furnished":
            return {"failed": "not done", "wall": limit / 2}
        return {"seconds": 2.0, "runs": 3, "wall": 8.0, "peak_gb": 0.1, "errors": {}}  # 2 s to start, 2 s a run

    monkeypatch.setattr(rooms["apart"], "run", measured)
    kept = {}
    args = argparse.Namespace(bands=[60, 20, 90], accuracies=[0.03], threads=1, quick=False)
    tool.measure_scene("white_box", args, kept, lambda: None, 60.0)
    assert asked == [
        ("published", ("bands", 20), 30.0),
        ("solver", ("bands", 20), 30.0),
        ("solver", ("bands", 60), 22.0),  # 3 times 4 s or more
        ("solver", ("accuracy", 0.03), 14.0),
    ]
    rows = {(row["method"], *row["setting"].values()): row for row in kept["white_box"]["measured"]}
    assert set(rows) == {(m, b) for m in ("published", "solver") for b in (20, 60, 90)} | {("solver", 0.03)}
    for left_out in (("published", 60), ("published", 90), ("solver", 90)):
        assert "left out" in rows[left_out]["failed"]
    asked.clear()
    tool.measure_scene("furnished", args, kept, lambda: None, 60.0)  # the trial for an accuracy would fail as well
    assert [task[:2] for task in asked] == [("published", ("bands", 20)), ("solver", ("bands", 20))]


def test_scenes_share_what_is_left(rooms):
    share = rooms["time_and_error"].shares
    assert share(["white_box", "furnished"], 80.0) == 20.0
    assert share(["furnished", "white_box"], 80.0) == 60.0
    assert share(["white_box"], 7.0) == 7.0


def test_every_scene_is_sound(rooms):
    for name in rooms["scenes"].NAMES + rooms["scenes"].OTHERS:
        scene = rooms["scenes"].load(name)
        assert len(scene.solver_scene().surfaces) == len(scene.surfaces)
        for measure in scene.measures:
            assert measure.points.shape == measure.normals.shape == (len(measure.lux), 3)
            assert (measure.lux > 0).all() and measure.noise < 0.005
            assert not measure.errors(measure.lux).any()


def test_published_method_closes_in_a_white_box(rooms):
    scene = rooms["scenes"].load("white_box")
    solved = rooms["hit_or_miss"].HitOrMiss(scene.surfaces, [luz.Daylight()], bands=8, max_area=0.5, threads=1)
    got = solved.at(scene.measures[0].points, scene.measures[0].normals, 0, initial=False)
    assert got == pytest.approx(10_000, rel=1e-3)


def test_published_method_follows_mirrors(rooms):
    scene = rooms["scenes"].load("light_pipe")
    lights = [measure.light for measure in scene.measures]
    solved = rooms["hit_or_miss"].HitOrMiss(scene.surfaces, lights, bands=20, max_area=0.02, threads=1)
    for k, measure in enumerate(scene.measures):
        error = measure.errors(solved.at(measure.points, measure.normals, k, initial=True))
        assert np.abs(error).max() < 0.05


def test_brute_force_knows_a_long_window(rooms):
    """Uniform sky through a window from floor to ceiling, so wide that nothing else counts: lux by the angles."""
    tools = rooms["brute_force"]
    far = tools.quads_of(
        {"aside": {"quads": [[[0, 9, 0], [1, 9, 0], [1, 10, 0], [0, 10, 0]]], "diffuse_reflectance": 0.5}}
    )
    opening = tools.Opening(np.array([(-500, 3, 1), (500, 3, 1), (500, 3, 2.5), (-500, 3, 2.5)], float))
    rng = np.random.default_rng(1)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tools, "overcast", lambda directions: np.full(len(directions), 1000.0))
        got, error = tools.initial(far, opening, np.zeros(3), np.array([0.0, 0.0, 1.0]), 800_000, rng)
    expected = 500 * math.pi * (math.cos(math.atan2(1, 3)) - math.cos(math.atan2(2.5, 3)))
    assert abs(got - expected) < max(5 * error, 1e-3 * expected)


@pytest.mark.parametrize("name", ["louvres", "furnished"])
def test_references_come_out_again(rooms, name):
    """A few paths, other lots: the stored values of some places within five standard errors."""
    tools = rooms["brute_force"]
    kept = {bool(m.initial): m for m in rooms["scenes"].load(name).measures}[False]
    quads = tools.quads_of(tools.ROOMS[name][0]())
    s, low, high = tools.SIZE, tools.SILL, tools.HEAD
    opening = tools.Opening(np.array([(0, s, low), (s, s, low), (s, s, high), (0, s, high)], float))
    rng = np.random.default_rng(7)
    for k in (1, 12):
        direct = tools.initial(quads, opening, kept.points[k], kept.normals[k], 8000, rng)
        more = tools.reflected(quads, opening, kept.points[k], kept.normals[k], 8000, rng)
        assert abs(direct[0] + more[0] - kept.lux[k]) < 5 * math.hypot(direct[1], more[1])
