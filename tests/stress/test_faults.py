"""Faults from without: cancelling, a full disk, damaged files, no memory. Nothing is left half-done."""

import errno
import io
import json

import numpy as np
import pytest
from builders import UNIFORM, box, prepare_coarse

import luzespecular as luz
from luzespecular import files, form_factors

GREY = luz.Material(diffuse_reflectance=0.5)
SUNNY = luz.Daylight(sky=luz.UniformSky(1000.0), sun=luz.Sun(altitude=60, azimuth=0, normal_illuminance=5e4))


def room():
    scene = box(GREY, (3, 3, 3), without=("north",))
    scene.add("mirror", [[0, 3, 1], [3, 3, 1], [3, 2, 1], [0, 2, 1]], luz.Material(specular_reflectance=0.8))
    return scene


def counted(act):
    """The stages of a run's reports."""
    calls = []
    act(lambda fraction, stage: calls.append(stage) or True)
    return calls


def test_cancelling_at_any_stage_leaves_all_as_it_was():
    scene = room()
    before = {name: surface.pieces.copy() for name, surface in scene.surfaces.items()}
    transfer = prepare_coarse(scene, elements=60, bands=8)
    usual = transfer.solve(SUNNY).illuminance

    def prepare(progress):
        return prepare_coarse(scene, elements=60, bands=8, progress=progress)

    def solve(progress):
        return transfer.solve(SUNNY, progress=progress)

    for act in (prepare, solve):
        stages = list(dict.fromkeys(counted(act)))
        assert len(stages) > 3
        for stop in stages:
            with pytest.raises(luz.Cancelled, match="Cancelled"):
                act(lambda fraction, stage, stop=stop: stage != stop)
    np.testing.assert_array_equal(transfer.solve(SUNNY).illuminance, usual)
    for name, pieces in before.items():
        np.testing.assert_array_equal(scene.surfaces[name].pieces, pieces)


def test_a_progress_that_fails_is_not_swallowed():
    def broken(fraction, stage):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        prepare_coarse(room(), elements=60, bands=8, progress=broken)


class FullDisk(io.RawIOBase):
    """Takes some bytes and no more."""

    def __init__(self, room=100):
        self.left = room

    def writable(self):
        return True

    def write(self, data):
        self.left -= len(data)
        if self.left < 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        return len(data)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # zipfile, as it is thrown away
@pytest.mark.parametrize("kind", ["csv", "json", "npz", "transfer"])
def test_a_full_disk_leaves_the_old_file(tmp_path, monkeypatch, kind):
    path = tmp_path / f"result.{kind}"
    path.write_text("what was there", encoding="utf-8")
    transfer = prepare_coarse(room(), elements=60, bands=8) if kind == "transfer" else None

    def full(self, mode="r", *args, **options):
        raw = FullDisk()
        return io.BufferedWriter(raw) if "b" in mode else io.TextIOWrapper(io.BufferedWriter(raw), encoding="utf-8")

    act = {
        "csv": lambda: files.write_csv(path, ["a"], [[k] for k in range(100_000)]),
        "json": lambda: files.write_json(path, list(range(100_000))),
        "npz": lambda: files.write_arrays(path, {"a": np.random.default_rng(0).random(100_000)}),
        "transfer": lambda: transfer.save(path),
    }[kind]
    with monkeypatch.context() as patch:
        patch.setattr(type(path), "open", full)
        with pytest.raises(OSError, match="No space left"):
            act()
    assert path.read_text(encoding="utf-8") == "what was there"
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


def test_no_memory_says_so_and_harms_nothing(monkeypatch):
    scene = room()

    def exhausted(*args, **options):
        raise MemoryError("Unable to allocate 9 TiB")

    with monkeypatch.context() as patch:
        patch.setattr(form_factors, "gather", exhausted)
        with pytest.raises(MemoryError, match="Unable to allocate"):
            prepare_coarse(scene, elements=60, bands=8)
    assert prepare_coarse(scene, elements=60, bands=8).solve(UNIFORM).illuminance.min() > 0


def test_a_scene_changed_while_it_is_solved_counts_as_it_was():
    scene = room()
    usual = prepare_coarse(scene, elements=60, bands=8).solve(SUNNY).illuminance

    def meddle(fraction, stage):
        if f"late {stage}" not in scene.surfaces and stage != "planes":
            scene.add(f"late {stage}", [[0, 0, 2], [3, 0, 2], [3, 3, 2], [0, 3, 2]], GREY)
        return True

    transfer = prepare_coarse(scene, elements=60, bands=8, progress=meddle)
    result = transfer.solve(SUNNY)
    assert len(result.illuminance) == len(usual)
    np.testing.assert_allclose(result.illuminance, usual, rtol=1e-6)


@pytest.mark.parametrize("seed", range(60))
def test_damaged_scene_files_are_refused_or_sound(tmp_path, seed):
    """Random bytes in a good file: a scene, or a refusal that names the file."""
    rng = np.random.default_rng(seed)
    content = {
        "materials": {"white": {"diffuse_reflectance": 0.5}},
        "surfaces": [
            {"name": "floor", "material": "white", "vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]},
            {
                "name": "mesh",
                "material": "white",
                "vertices": [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
                "faces": [[0, 1, 2], [0, 2, 3]],
            },
        ],
    }
    text = bytearray(json.dumps(content).encode())
    for place in rng.integers(0, len(text), 1 + seed % 5):
        text[place] = rng.integers(0, 256)
    path = tmp_path / "scene.json"
    path.write_bytes(bytes(text[: len(text) - (seed % 3) * int(rng.integers(0, 100))]))
    try:
        luz.check(files.read_scene(path).scene)
    except luz.SceneError as error:
        assert "scene.json" in str(error)


@pytest.mark.parametrize("seed", range(60))
def test_random_meshes_are_refused_or_sound(seed):
    rng = np.random.default_rng(seed)
    vertices = rng.normal(size=(rng.integers(3, 12), 3)) * 10.0 ** rng.integers(-8, 9)
    if seed % 2:
        vertices = np.rint(rng.normal(size=vertices.shape) * 2)
    faces = [rng.integers(0, len(vertices), rng.integers(3, 7)).tolist() for _ in range(rng.integers(1, 15))]
    scene = luz.Scene()
    try:
        scene.add("mesh", vertices, GREY, faces=faces, two_sided=bool(seed % 3))
    except luz.SceneError as error:
        assert "'mesh'" in str(error)
        return
    for finding in luz.check(scene):
        assert (finding.faces < len(faces)).all() and (finding.faces >= 0).all()
    assert scene.surfaces["mesh"].source_faces.max() < len(faces)
