"""100,000 faces on Blender's side: values arrive right, and the work grows no faster than the faces."""

import importlib.util
import sys
import time
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
FEW, MANY = 25_000, 100_000
GROWTH = 2.5
"""How much more than proportional the work may grow; sorting and memory's levels cost some of it, and a machine at work
on other things. Work that grew with the square of the faces would be at 4."""


@pytest.fixture(scope="module")
def bench():
    """The benchmark's own scenes and made-up results: ``benchmarks/blender_side.py`` says how long they take."""
    spec = importlib.util.spec_from_file_location("blender_side", ROOT / "benchmarks" / "blender_side.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def run(addon, bpy, make, bench):
    """Read a scene of so many faces and write made-up results back: processor time, object and result."""

    def once(faces, **display):
        for object_ in list(bpy.data.objects):
            bpy.data.objects.remove(object_)
        settings = make.quick()
        for name, value in display.items():
            setattr(settings.display, name, value)
        hills = bench.grid(faces)
        bpy.context.view_layer.update()
        start = time.process_time()
        study = addon.study.collect(bpy.context)
        collected = time.process_time()
        result = bench.made_up_result(study.export)
        made_up = time.process_time()
        addon.study.finish(bpy.context, study, result)
        return time.process_time() - made_up + collected - start, hills, result

    return once


@pytest.mark.parametrize("modified", [False, True])
def test_values_of_many_faces_arrive(addon, bpy, make, bench, run, modified):
    if modified:
        grid = bench.grid

        def displaced(faces):
            made = grid(faces)
            made.modifiers.new("Move", "DISPLACE").strength = 0.0
            return made

        bench.grid = displaced
    try:
        _, hills, result = run(MANY)
    finally:
        if modified:
            bench.grid = grid
    assert abs(len(hills.data.polygons) - MANY) < 1_000
    own = addon.mesh_arrays.read_face_values(hills.data, "illuminance", np.float32)
    pairs, weights = result.illuminance.reshape(-1, 2), result.areas.reshape(-1, 2)
    np.testing.assert_allclose(own, (pairs * weights).sum(axis=1) / weights.sum(axis=1), rtol=1e-5)


@pytest.mark.parametrize("display", [{}, {"view": "OWN"}, {"shading": "SMOOTH"}])
def test_work_grows_as_the_faces_do(run, display):
    run(FEW, **display)  # the first pays for what is loaded and allocated once
    few, many = (min(run(faces, **display)[0] for _ in range(3)) for faces in (FEW, MANY))
    assert many / few < GROWTH * MANY / FEW
