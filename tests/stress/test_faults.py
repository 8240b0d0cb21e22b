"""Faults from without: cancelling, a full disk, damaged files, no memory. Nothing is left half-done."""

import errno
import io
import sys

import fuzz
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


def test_cancelling_a_year_leaves_all_as_it_was():
    transfer = prepare_coarse(room(), elements=60, bands=8)
    lights = [SUNNY, UNIFORM, luz.Daylight(sun=luz.Sun(altitude=20, azimuth=80, normal_illuminance=5e4))]
    usual = transfer.solve_many(lights)
    for run in (transfer.solve_many, transfer.annual):
        stages = list(dict.fromkeys(counted(lambda progress, run=run: run(lights, progress=progress))))
        assert stages
        for stop in stages:
            with pytest.raises(luz.Cancelled, match="Cancelled"):
                run(lights, progress=lambda fraction, stage, stop=stop: stage != stop)
    np.testing.assert_array_equal(transfer.solve_many(lights), usual)


def test_cancelling_leaves_no_cache_behind(tmp_path):
    path = tmp_path / "kept"
    stages = list(
        dict.fromkeys(counted(lambda p: prepare_coarse(room(), elements=60, bands=8, progress=p, cache=path)))
    )
    path.unlink()
    for stop in stages[:-1]:
        with pytest.raises(luz.Cancelled):
            prepare_coarse(room(), elements=60, bands=8, cache=path, progress=lambda f, stage, stop=stop: stage != stop)
        assert not list(tmp_path.iterdir())


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


def test_no_memory_while_solving_leaves_the_transfer_whole(monkeypatch):
    transfer = prepare_coarse(room(), elements=60, bands=8)
    usual = transfer.solve(SUNNY).illuminance

    def exhausted(*args, **options):
        raise MemoryError("Unable to allocate 9 TiB")

    for name in ("gather_patches", "Bright", "follow_sun"):
        with monkeypatch.context() as patch:
            patch.setattr(sys.modules["luzespecular.solve"], name, exhausted)
            with pytest.raises(MemoryError, match="Unable to allocate"):
                transfer.solve(SUNNY)
    np.testing.assert_array_equal(transfer.solve(SUNNY).illuminance, usual)


def test_no_memory_while_saving_leaves_the_old_file(tmp_path, monkeypatch):
    transfer, path = prepare_coarse(room(), elements=60, bands=8), tmp_path / "kept"
    path.write_text("what was there", encoding="utf-8")

    def exhausted(file, **arrays):
        file.write(b"half of it")
        raise MemoryError("Unable to allocate 9 TiB")

    monkeypatch.setattr(np, "savez", exhausted)
    with pytest.raises(MemoryError, match="Unable to allocate"):
        transfer.save(path)
    assert path.read_text(encoding="utf-8") == "what was there" and len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize("damage", ["whole", "cut off", "bytes", "empty"])
def test_tables_are_never_taken_for_scenes_or_transfers(tmp_path, damage):
    """Nothing reads the tables that are written: given where a scene or a cache is wanted, they are refused by name."""
    path = files.write_csv(tmp_path / "lux.csv", ["surface", "lux"], [["floor", float(k)] for k in range(50)])
    content = path.read_bytes()
    path.write_bytes(
        {"whole": content, "cut off": content[:77], "bytes": content[:40] + bytes(range(128, 255)), "empty": b""}[
            damage
        ]
    )
    given = path.read_bytes()
    with pytest.raises(luz.SceneError, match=r"lux\.csv"):
        files.read_scene(path)
    with pytest.raises(luz.TransferFileError, match=r"lux\.csv"):
        luz.load(path, room())
    assert path.read_bytes() == given


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


@pytest.mark.parametrize("kind", range(len(set(fuzz.TRIALS))))
def test_random_input_is_refused_or_sound(tmp_path, kind):
    """Some hundred trials of benchmarks/fuzz.py, which runs any number of them."""
    mine = [number for number in range(1200) if fuzz.TRIALS[number % len(fuzz.TRIALS)] is sorted_trials()[kind]]
    for number in mine[:30]:
        fuzz.trial(number, tmp_path)


def sorted_trials():
    return sorted(set(fuzz.TRIALS), key=lambda trial: trial.__name__)


@pytest.mark.parametrize(
    ("kind", "number"),
    [
        *(("one_polygon", number) for number in (5, 63, 194, 8927, 9750, 14966)),
        *(("mesh", number) for number in (10139, 11065, 14365, 18193)),
    ],
)
def test_trials_that_found_something(tmp_path, kind, number):
    """Loops that cross at corners; spikes, which gave no light at all; coarse meshes of less light than none."""
    fuzz.one_of(getattr(fuzz, kind), number, tmp_path)
