"""The performance benchmark still runs, in its smallest setting, and compares like with like; no timings asserted."""

import importlib
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
MODULES = ("apart", "scenes", "rooms", "beside_embree", "beside_radiance", "cost_model", "solver_side")
EXACT = (
    "specular chains",
    "sky of a closed scene",
    "Sun below the horizon",
    "shadows on backs, sun patches",
    "visibility, where reflectances change",
    "visibility, from a file",
)
"""Skips that change no light."""


@pytest.fixture(scope="module")
def tools():
    """The benchmark's modules by name, which are forgotten afterwards: others have such names too."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(BENCHMARKS))
        for name in (*MODULES, "performance_page"):
            patch.delitem(sys.modules, name, raising=False)
        yield {name: importlib.import_module(name) for name in (*MODULES, "performance_page")}
        for name in (*MODULES, "performance_page"):
            sys.modules.pop(name, None)


def run(folder, *parts):
    """What a quick run of some parts writes."""
    command = [sys.executable, BENCHMARKS / "performance.py", "--quick", "--threads", "1", "--output", folder]
    done = subprocess.run([*command, "--parts", *parts], capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stderr
    assert (folder / "performance.png").stat().st_size > 10_000
    state = json.loads((folder / "measurements.json").read_text(encoding="utf-8"))
    assert set(parts) <= set(state)
    assert "failed" not in json.dumps(state), done.stdout
    return state, (folder / "performance.md").read_text(encoding="utf-8")


def test_stages_model_and_skips(tmp_path):
    state, page = run(tmp_path, "stages", "model", "skips")
    whole = state["stages"]["whole"]
    assert {"visibility and form factors", "sky", "sun", "interreflection"} <= set(whole["stages"])
    assert all(row["seconds"] > 0 and row["peak_gb"] > 0 for row in state["stages"]["reuse"].values())
    counts = state["model"]["counts"]
    assert counts["cells"] > 0 and counts["cell edges"] > counts["cells"] and counts["candidates"] > counts["crossed"]
    told = [row for row in state["model"]["rows"] if "predicted" in row]
    assert len(told) >= 8 and all(row["predicted"] > 0 and row["measured"] > 0 for row in told)
    for name, row in state["skips"].items():
        assert np.isfinite([row["with"], row["without"], row["change"]]).all()
        assert row["change"] <= 1e-12 if name in EXACT else row["median_change"] < 0.2, name
    for heading in ("### The cost model", "| **arrays in → lux out** |", "| specular chains |", "Not measured."):
        assert heading in page


def test_growth_and_what_was_measured_before(tmp_path):
    state, page = run(tmp_path, "growth")
    for rows in state["growth"].values():
        assert len(rows) == 2 and rows[0]["x"] < rows[1]["x"]
        assert all(row["seconds"] > 0 and row["peak_gb"] > 0 for row in rows)
    assert "doubling costs" in page
    kept, _ = run(tmp_path, "model")
    assert kept["growth"] == state["growth"]


def test_what_does_not_fit_is_left_out(tmp_path):
    command = [sys.executable, BENCHMARKS / "performance.py", "--quick", "--output", tmp_path, "--minutes", "0.001"]
    done = subprocess.run([*command, "--parts", "growth"], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    assert "left out: over the budget" in (tmp_path / "performance.md").read_text(encoding="utf-8")


def test_embree_meets_what_the_solver_sees(tmp_path):
    pytest.importorskip("embreex")
    state, page = run(tmp_path, "embree")
    found = state["embree"]
    assert found["agree"] > 0.999 and found["agree_rays"] > 0.999
    assert [row["what"] for row in found["rows"]][:3] == ["Embree", "nearest surface alone", "visibility"]
    assert found["rows"][0]["directions"] == found["rows"][1]["directions"] == found["rows"][2]["directions"] > 0
    assert "times Embree's rate" in page


def test_radiance_runs(tmp_path):
    pytest.importorskip("pyradiance")
    state, page = run(tmp_path, "radiance")
    assert len(state["radiance"]["radiance"]) == 2
    assert "| Radiance | `-ab 1 -ad 8 -as 0 -aa 0` |" in page


def test_radiance_is_given_the_same_room(tools):
    """Sky, Sun, its image in the shelf and reflectances are right, where chance leaves a few percent."""
    pytest.importorskip("pyradiance")
    scene = tools["scenes"].load("seed_room_noon")
    (measure,) = scene.measures
    setting = {"cache": False, "ab": 6, "ad": 256, "as": 64}
    lux = tools["beside_radiance"].trace(scene, measure.light, measure.points, measure.normals, setting, threads=2)
    error = measure.errors(lux)
    assert abs(error.mean()) < 0.05 and np.sqrt(np.mean(error**2)) < 0.08


def test_missing_engines_are_told(tools, monkeypatch):
    page, embree = tools["performance_page"], tools["beside_embree"]
    monkeypatch.setattr(embree, "available", lambda: False)
    with tools["rooms"].coarsely():
        found = embree.compare(bands=8, max_area=0.5, threads=1, repeats=1, most_seconds=1.0)
    assert [row["what"] for row in found["rows"][:2]] == ["nearest surface alone", "visibility"]
    assert "pip install" in "".join(page.embree_text(found, {}))
    told = page.radiance_text({"solver": [], "radiance": [], "noise": 0.2, "installed": False}, {})
    assert "pip install" in "".join(told)


def test_slopes_are_those_of_powers(tools):
    x = np.array([1.0, 2.0, 4.0])
    assert tools["solver_side"].slope(x, 3 * x**1.5) == pytest.approx(1.5)


def test_medians_run_in_turn(tools):
    order = []
    works = {"a": lambda: order.append("a"), "b": lambda: order.append("b")}
    seconds, runs = tools["apart"].medians(works, 3, 10.0)
    assert order == ["a", "b"] * 3 and runs == 3 and set(seconds) == {"a", "b"}


def test_watched_steps_do_not_count_those_inside(tools):
    watch = tools["cost_model"].Watch()

    def spin(count):
        return sum(i * i for i in range(count))

    inner = watch.timed("inner", lambda: spin(400_000))
    watch.timed("outer", lambda: (inner(), spin(40_000)))()
    seconds = watch.stop()
    assert 0 < seconds["outer"] < seconds["inner"]
