"""Saved transfers: the same lux from a file, and no use of one that is stale, damaged or foreign."""

import dataclasses
import errno
import json
import math

import numpy as np
import pytest
from builders import box, prepare_coarse
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import luzespecular as luz
from luzespecular import store, writing

WHITE = luz.Material(diffuse_reflectance=0.5)
MIRROR = luz.Material(specular_reflectance=0.8)
PANE = luz.Material(regular_transmittance=0.8, refractive_index=1.52)
NOON = luz.Daylight(
    sky=luz.CIESky(12, sun_altitude=50, sun_azimuth=20, horizontal_illuminance=10_000),
    sun=luz.Sun(altitude=50, azimuth=20, normal_illuminance=60_000),
    ground_reflectance=0.2,
)


def screen_at(further):
    return np.array([[1, 1, 0], [2, 1, 0], [2, 1, 1.5], [1, 1, 1.5]]) + np.array([0, further, 0])


def room(floor=WHITE, screen=None, lamp=0.0, ceiling=MIRROR, north=PANE):
    scene = box(WHITE, (3, 2, 2.5), ceiling=ceiling, north=north, floor=floor)
    shape = screen_at(0) if screen is None else screen
    scene.add("screen", shape, luz.Material(diffuse_reflectance=0.3, exitance=lamp), two_sided=True)
    return scene


@pytest.fixture(scope="module")
def prepared():
    return coarse(room())


@pytest.fixture(scope="module")
def saved(prepared, tmp_path_factory):
    return prepared.save(tmp_path_factory.mktemp("área de trabalho") / "casa à luz.npz")


ANEW = 1e-6
"""Two preparations agree to the rounding of single precision: it depends on where arrays lie in memory."""


def coarse(scene, **options):
    return prepare_coarse(scene, elements=100, patches=60, **{"bands": 12, "max_area": 0.4, **options})


def load(path, scene=None, **options):
    """`luz.load` where geometry is cut as by `prepare_coarse`."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(luz.fracture, "FEWEST_ELEMENTS", 100)
        patch.setattr(luz.fracture, "ELEMENTS_PER_PLAIN_SURFACE", 10)
        patch.setattr(luz.geometry, "PATCHES", 60)
        return luz.load(path, room() if scene is None else scene, **options)


def assert_same_light(one, other, rtol=0.0):
    a, b = one.solve(NOON), other.solve(NOON)
    for name in a.components:
        np.testing.assert_allclose(a.components[name], b.components[name], rtol=rtol, atol=0, err_msg=name)
        np.testing.assert_allclose(a.back.components[name], b.back.components[name], rtol=rtol, atol=0, err_msg=name)
    np.testing.assert_allclose(a.error, b.error, rtol=max(10 * rtol, 1e-12))
    place, normal = [[1.5, 0.5, 0.8]], [[0, 0, 1]]
    np.testing.assert_allclose(a.at(place, normal), b.at(place, normal), rtol=rtol)
    assert a.balance == b.balance or rtol > 0


def test_what_is_loaded_gives_the_same_light_to_the_last_bit(prepared, saved):
    assert_same_light(load(saved), prepared)


def test_a_loaded_transfer_knows_its_options_and_stages(prepared, saved):
    loaded = load(saved, threads=3)
    assert loaded.fingerprint == prepared.fingerprint
    assert loaded.fingerprint.options["bands"] == 12
    assert loaded.stages == prepared.stages
    assert loaded.threads == 3


def test_a_loaded_transfer_can_be_saved(saved, tmp_path):
    again = load(saved).save(tmp_path / "again.npz")
    assert_same_light(load(again), load(saved))


def test_files_are_plain_arrays(saved):
    with np.load(saved, allow_pickle=False) as content:
        assert all(content[name].dtype.kind in "fiu" for name in content.files)


def test_other_reflectances_and_exitances_need_no_new_file(saved):
    scene = room(floor=luz.Material(diffuse_reflectance=0.9))
    assert_same_light(load(saved, scene), coarse(scene), rtol=ANEW)


@pytest.mark.parametrize(
    "scene, what",
    [
        (room(screen=screen_at(0.1)), "another shape of 'screen'"),
        (room(screen=screen_at(0)[::-1]), "another shape of 'screen'"),
        (room(ceiling=luz.Material(specular_reflectance=0.7)), "'ceiling' that mirrors"),
        (room(north=luz.Material(regular_transmittance=0.8)), "'north' that mirrors, transmits"),
        (room(floor=luz.Material()), "'floor' that"),
        (room(lamp=100.0), "'screen' that"),
        (box(WHITE, (3, 2, 2.5), ceiling=MIRROR, north=PANE), "with a surface 'screen'"),
    ],
)
def test_stale_files_are_refused(saved, scene, what):
    with pytest.raises(luz.TransferFileError, match=r"casa à luz\.npz' is stale") as caught:
        load(saved, scene)
    assert what in str(caught.value)
    assert "prepare the scene" in str(caught.value)


def test_a_surface_more_or_another_order_is_refused(saved):
    scene = room()
    scene.add("more", screen_at(0.2), WHITE)
    with pytest.raises(luz.TransferFileError, match="without the surface 'more'"):
        load(saved, scene)
    turned = luz.Scene(dict(reversed(room().surfaces.items())))
    with pytest.raises(luz.TransferFileError, match="another order"):
        load(saved, turned)


def test_a_file_is_refused_where_scenes_are_cut_otherwise(saved):
    with pytest.raises(luz.TransferFileError, match="cut otherwise"):
        luz.load(saved, room())


def test_another_format_is_refused(saved, prepared, tmp_path, monkeypatch):
    monkeypatch.setattr(store, "FORMAT", store.FORMAT + 1)
    with pytest.raises(luz.TransferFileError, match="another version"):
        load(saved)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04", b"not a transfer", b"\x80\x04N.", b"\x93NUMPY\x01\x00v\x00"])
def test_foreign_files_are_refused(tmp_path, content):
    path = tmp_path / "foreign.npz"
    path.write_bytes(content)
    with pytest.raises(luz.TransferFileError, match=r"foreign\.npz"):
        load(path)


def test_other_arrays_are_refused(tmp_path):
    np.savez(tmp_path / "other.npz", lux=np.zeros(3))
    with pytest.raises(luz.TransferFileError, match=r"other\.npz' is no saved transfer"):
        load(tmp_path / "other.npz")
    np.save(tmp_path / "other.npy", np.zeros(3))
    with pytest.raises(luz.TransferFileError, match=r"other\.npy"):
        load(tmp_path / "other.npy")
    np.savez(tmp_path / "header.npz", header=np.frombuffer(json.dumps([1]).encode(), np.uint8))
    with pytest.raises(luz.TransferFileError, match=r"header\.npz"):
        load(tmp_path / "header.npz")


def test_a_missing_file_is_told_as_such(tmp_path):
    with pytest.raises(FileNotFoundError):
        load(tmp_path / "none.npz")


@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_damaged_files_never_give_light(saved, tmp_path, data):
    """Whatever bytes are lost or changed: refused by name, unless they mean nothing."""
    content = bytearray(saved.read_bytes())
    if data.draw(st.booleans()):
        del content[data.draw(st.integers(0, len(content) - 1)) :]
    else:
        start = data.draw(st.integers(0, len(content) - 1))
        for k in range(start, min(start + data.draw(st.integers(1, 200)), len(content))):
            content[k] ^= 0x55
    path = tmp_path / "damaged.npz"
    path.write_bytes(content)
    try:
        loaded = load(path)
    except luz.TransferFileError as error:
        assert "damaged.npz" in str(error)
    else:
        np.testing.assert_array_equal(loaded.form_factors, load(saved).form_factors)
        np.testing.assert_array_equal(loaded.sky_direct.dense(), load(saved).sky_direct.dense())


def altered(saved, path, **arrays):
    with np.load(saved) as content:
        np.savez(path, **{**{name: content[name] for name in content.files}, **arrays})
    return path


@pytest.mark.parametrize(
    "name, change",
    [
        ("form_factors", lambda a: a[:-1]),
        ("form_factors", lambda a: a.astype(float)),
        ("sky_direct_values", lambda a: np.full_like(a, np.nan)),
        ("nodes_element", lambda a: a + 100_000),
        ("weights_start", lambda a: a[::-1].copy()),
        ("weights_node", lambda a: -a - 1),
        ("sky_specular_rows", lambda a: a + 100_000),
        ("sky_direct_sizes", lambda a: a[::-1] + 1),
        ("sky_direct_columns", lambda a: a[:-1]),
    ],
)
def test_arrays_that_do_not_fit_are_refused(saved, tmp_path, name, change):
    with np.load(saved) as content:
        values = change(content[name])
    with pytest.raises(luz.TransferFileError, match="damaged"):
        load(altered(saved, tmp_path / "altered.npz", **{name: values}))


def test_a_full_disk_leaves_nothing_half_written(prepared, tmp_path, monkeypatch):
    path = tmp_path / "transfer.npz"
    path.write_bytes(b"before")

    def full(file, **arrays):
        file.write(b"some")
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(np, "savez", full)
    with pytest.raises(OSError, match="No space"):
        prepared.save(path)
    assert path.read_bytes() == b"before"
    assert [p.name for p in tmp_path.iterdir()] == ["transfer.npz"]


def cached(scene, path, **options):
    return coarse(scene, cache=path, **options)


def skipped(transfer, name):
    return [stage.skipped for stage in transfer.stages if stage.name == name and stage.skipped]


def test_a_cache_is_written_once_and_used_again(prepared, tmp_path):
    path = tmp_path / "cache.npz"
    first = cached(room(), path)
    assert "not there yet" in skipped(first, "cache")[0]
    written = path.stat().st_mtime_ns
    second = cached(room(), str(path))
    assert path.stat().st_mtime_ns == written
    assert "taken from" in skipped(second, "visibility and form factors")[0]
    assert_same_light(first, second)
    assert_same_light(prepared, second, rtol=ANEW)


@pytest.mark.parametrize(
    "options, scene, what",
    [
        ({"bands": 20}, room(), "bands=12, not bands=20"),
        ({}, room(screen=screen_at(0.1)), "another shape of 'screen'"),
        ({"specular_cutoff": 0.1}, room(), "specular_cutoff"),
    ],
)
def test_a_stale_cache_is_written_anew_with_the_reason(tmp_path, options, scene, what):
    path = tmp_path / "cache.npz"
    cached(room(), path)
    fresh = cached(scene, path, **options)
    assert what in skipped(fresh, "cache")[0]
    assert_same_light(cached(scene, path, **options), fresh)
    assert not skipped(cached(scene, path, **options), "cache")


def test_a_damaged_cache_is_written_anew(tmp_path):
    path = tmp_path / "cache.npz"
    path.write_bytes(b"something else")
    assert "damaged" in skipped(cached(room(), path), "cache")[0]
    assert not skipped(cached(room(), path), "cache")


def test_a_cache_that_cannot_be_written_loses_no_transfer(prepared, tmp_path, monkeypatch, caplog):
    monkeypatch.setattr(np, "savez", lambda *_, **__: (_ for _ in ()).throw(OSError(errno.ENOSPC, "No space left")))
    transfer = cached(room(), tmp_path / "cache.npz")
    assert "No space left" in skipped(transfer, "cache")[-1]
    assert "No space left" in caplog.text
    assert_same_light(transfer, prepared, rtol=ANEW)


@pytest.mark.parametrize("path", [7, ".", "no such folder/cache.npz"])
def test_a_cache_in_no_place_is_refused_before_work(path):
    with pytest.raises(luz.SceneError, match="cache"):
        luz.prepare(room(), cache=path)


def test_accuracy_is_part_of_what_a_file_is_for(tmp_path):
    path = tmp_path / "cache.npz"
    first = cached(room(), path, accuracy=0.15)
    second = cached(room(), path, accuracy=0.15)
    assert "taken from" in skipped(second, "visibility and form factors")[0]
    assert second.geometry.targets.globe.bands == first.geometry.targets.globe.bands
    assert_same_light(first, second)
    assert "accuracy=0.15" in skipped(cached(room(), path), "cache")[0]


@pytest.mark.parametrize("max_area", [None, math.inf, 0.1])
def test_files_keep_every_kind_of_option(tmp_path, max_area):
    transfer = coarse(box(WHITE, without=("north",)), bands=8, max_area=max_area)
    path = transfer.save(tmp_path / "transfer.npz")
    assert load(path, box(WHITE, without=("north",))).fingerprint == transfer.fingerprint


# Reuse in memory


def test_other_materials_give_what_a_fresh_preparation_gives(prepared):
    scene = room(floor=luz.Material(diffuse_reflectance=0.05))
    changed = prepared.with_materials(scene)
    assert_same_light(changed, coarse(scene), rtol=ANEW)
    assert changed.form_factors is prepared.form_factors
    assert "earlier transfer" in skipped(changed, "visibility and form factors")[0]
    assert prepared.solve(NOON).mean("floor") > 1.02 * changed.solve(NOON).mean("floor")


def test_other_exitances_give_what_a_fresh_preparation_gives():
    dim, bright = room(lamp=100.0), room(lamp=2000.0)
    changed = coarse(dim).with_materials(bright)
    assert_same_light(changed, coarse(bright), rtol=ANEW)


def test_other_shapes_are_refused_by_name(prepared):
    with pytest.raises(luz.SceneError, match="another shape of 'screen'; prepare"):
        prepared.with_materials(room(screen=screen_at(0.1)))
    with pytest.raises(luz.SceneError, match="Scene"):
        prepared.with_materials("room")


def test_prepare_takes_what_holds_and_says_what_does_not(prepared):
    scene = room(floor=luz.Material(diffuse_reflectance=0.05))
    kept = coarse(scene, reuse=prepared, threads=2)
    assert kept.form_factors is prepared.form_factors
    assert kept.threads == 2
    anew = coarse(room(screen=screen_at(0.1)), reuse=prepared)
    note = "the transfer was prepared for another shape of 'screen'; 0 of "
    assert [said[: len(note)] for said in skipped(anew, "reuse")] == [note]
    assert_same_light(anew, coarse(room(screen=screen_at(0.1))), rtol=ANEW)
    with pytest.raises(luz.SceneError, match="reuse"):
        luz.prepare(room(), reuse="before")


def test_a_transfer_does_not_follow_its_scene(prepared):
    """The fingerprint is that of the moment of preparation."""
    scene = room()
    transfer = coarse(scene)
    scene.add("late", screen_at(0.3), WHITE)
    assert dataclasses.asdict(transfer.fingerprint) == dataclasses.asdict(prepared.fingerprint)
    with pytest.raises(luz.SceneError, match="without the surface 'late'"):
        transfer.with_materials(scene)


def test_complete_files_only(tmp_path):
    with pytest.raises(RuntimeError), writing.complete(tmp_path / "x") as unfinished:
        unfinished.write_text("half")
        raise RuntimeError
    assert not list(tmp_path.iterdir())
