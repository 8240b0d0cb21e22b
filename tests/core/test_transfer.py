"""Preparing: form factors, threads, progress, cancelling, and that nothing of the scene changes."""

import math
import threading

import numpy as np
import pytest
from builders import BLACK, DARK, UNIFORM, box, prepare_coarse, scene_of
from hypothesis import given, settings
from hypothesis import strategies as st

import luzespecular as luz
from luzespecular import form_factors
from luzespecular.preparation import bytes_held

WHITE = luz.Material(diffuse_reflectance=0.5)
MIRROR = luz.Material(specular_reflectance=0.8)


def room():
    """An open room with a mirror and a screen: every stage has work."""
    scene = box(WHITE, (3, 2, 2.5), without=("north",), ceiling=MIRROR)
    scene.add("screen", [[1, 1, 0], [2, 1, 0], [2, 1, 1.5], [1, 1, 1.5]], WHITE, two_sided=True)
    return scene


def arrays(transfer):
    dense = {name: getattr(transfer, name) for name in ("form_factors", "patch_factors", "unlit", "truncated")}
    return dense | {name: getattr(transfer, name).dense() for name in ("sky_direct", "sky_specular")}


@settings(max_examples=15, deadline=None)
@given(
    st.tuples(st.floats(0.05, 20), st.floats(0.05, 20), st.floats(0.05, 20)),
    st.sampled_from([12, 24]),
)
def test_rows_of_any_closed_box_sum_to_one(size, bands):
    transfer = prepare_coarse(box(WHITE, size), elements=60, patches=30, bands=bands)
    np.testing.assert_allclose(transfer.form_factors.sum(axis=1), 1, atol=3e-5)
    np.testing.assert_array_equal(transfer.sky_direct.dense(), 0)
    np.testing.assert_allclose(transfer.patch_factors.sum(axis=1), 1, atol=3e-5)
    assert not transfer.unlit.any() and not transfer.truncated.any()


@pytest.mark.parametrize("bands", [24, 25])
def test_rows_of_an_open_room_sum_to_one_with_the_sky(bands):
    transfer = prepare_coarse(box(WHITE, (3, 2, 2.5), without=("north", "ceiling")), bands=bands)
    total = transfer.form_factors.sum(axis=1) + transfer.sky_direct.dense().sum(axis=1) + transfer.unlit
    np.testing.assert_allclose(total, 1, atol=1e-5)
    assert transfer.sky_direct.shape[1] == transfer.geometry.targets.sky_parcels + 1


def test_dark_backs_are_unlit():
    """A wall seen from behind takes its share of the view, and gives none."""
    scene = box(WHITE, without=("north",))
    scene.add("outward", [[0, 1, 0], [1, 1, 0], [1, 1, 1], [0, 1, 1]][::-1], WHITE)
    outward = prepare_coarse(scene)
    scene = box(WHITE, without=("north",))
    scene.add("inward", [[0, 1, 0], [1, 1, 0], [1, 1, 1], [0, 1, 1]], WHITE)
    inward = prepare_coarse(scene)
    light = {name: transfer for name, transfer in (("out", outward), ("in", inward))}
    dark = light["out"] if light["out"].unlit.any() else light["in"]
    seen = dark.form_factors.sum(axis=1) + dark.unlit + dark.sky_direct.dense().sum(axis=1)
    np.testing.assert_allclose(seen, 1, atol=1e-5)
    assert 0.1 < dark.unlit[dark.geometry.element_surface[dark.nodes.element] == 0].mean() < 0.4


def test_form_factors_are_reciprocal():
    """A_i F_ij = A_j F_ji, which nothing in the gathering enforces."""
    transfer = prepare_coarse(box(WHITE, (3, 2, 2.5)), elements=1500, patches=60, bands=60)
    cuts, patch = transfer.geometry.fracture, transfer.geometry.targets.patches.of_element
    area = np.bincount(patch, weights=cuts.element_areas)
    exchange = area[:, None] * transfer.patch_factors
    # some parcels wide, so that it does not matter which of two neighbours a beam's centre meets
    middle = np.stack([np.bincount(patch, weights=cuts.element_areas * x) / area for x in cuts.elements.mean(axis=1).T])
    block = np.unique(np.floor(middle).T, axis=0, return_inverse=True)[1].reshape(-1)
    blocks = np.zeros((block.max() + 1, block.max() + 1))
    np.add.at(blocks, (block[:, None], block[None, :]), exchange)
    assert np.abs(blocks - blocks.T).sum() / blocks.sum() < 0.02
    surface = np.zeros(len(area), int)
    surface[patch] = transfer.geometry.element_surface
    between = np.array([[exchange[np.ix_(surface == a, surface == b)].sum() for b in range(6)] for a in range(6)])
    np.testing.assert_allclose(between, between.T, rtol=3e-3, atol=1e-6)
    np.testing.assert_array_equal(np.diag(between), 0)


def test_patch_factors_are_means_over_elements():
    transfer = prepare_coarse(room())
    patch, area = transfer.geometry.targets.patches.of_element, transfer.geometry.fracture.element_areas
    for number in range(0, transfer.geometry.targets.patches.count, 7):
        mine = patch == number
        rows = transfer.nodes.weights.apply(transfer.form_factors.astype(float))[mine]
        mean = np.average(rows, axis=0, weights=area[mine])
        np.testing.assert_allclose(transfer.patch_factors[number], mean, rtol=1e-4, atol=1e-7)


def test_elements_follow_from_their_nodes():
    """What is even at the nodes is even on the elements; means stay, and nothing becomes negative."""
    transfer = prepare_coarse(room(), elements=500)
    area = transfer.geometry.fracture.element_areas
    np.testing.assert_allclose(transfer.on_elements(np.ones(len(transfer.nodes.points))), 1)
    steep = np.exp(-20 * transfer.nodes.points[:, 0])
    values = transfer.on_elements(steep)
    assert (values >= 0).all()
    linear = transfer.nodes.points @ [1.0, 2.0, 3.0] + 20
    exact = transfer.geometry.element_points @ [1.0, 2.0, 3.0] + 20
    got = transfer.on_elements(linear)
    assert area @ got == pytest.approx(area @ exact, rel=1e-12)
    lone = np.abs(got - exact) > 1e-9  # strips of a single cell know no change across
    assert lone.mean() < 0.1


@pytest.mark.parametrize("threads", [2, 5])
def test_threads_change_nothing(threads):
    one, more = prepare_coarse(room(), threads=1), prepare_coarse(room(), threads=threads)
    for name, values in arrays(one).items():  # sums by BLAS may differ in the last bit
        np.testing.assert_allclose(values, arrays(more)[name], rtol=1e-6, atol=1e-12, err_msg=name)
    light = luz.Daylight(sky=luz.UniformSky(1000.0), sun=luz.Sun(direction=(0.1, 1, 1), normal_illuminance=5e4))
    np.testing.assert_allclose(one.solve(light).illuminance, more.solve(light).illuminance, rtol=1e-6)


def test_a_scene_may_grow_after_it_was_prepared():
    scene = box(WHITE, without=("ceiling",))
    transfer = prepare_coarse(scene)
    before = transfer.solve(UNIFORM)
    scene.add("lid", [[0, 1, 1], [1, 1, 1], [1, 0, 1], [0, 0, 1]], BLACK)
    after = transfer.solve(UNIFORM)
    np.testing.assert_array_equal(after.illuminance, before.illuminance)
    assert "lid" not in after.surfaces and "lid" not in before.surfaces
    assert prepare_coarse(scene).solve(UNIFORM).illuminance.max() < 1e-6


def test_subdivided_walls_give_the_same_light_as_whole_ones():
    """A wall of many quads is one plane: the mesh that a modeller happens to have makes no difference."""
    corner = np.stack(np.meshgrid(np.linspace(0, 1, 6), np.linspace(0, 1, 6), indexing="ij"), axis=-1).reshape(-1, 2)
    quads = [(a, a + 6, a + 7, a + 1) for i in range(5) for j in range(5) for a in [6 * i + j]]
    meshed = box(WHITE, (3, 2, 2.5), without=("ceiling", "floor"))
    meshed.add("floor", np.c_[corner * [3, 2], np.zeros(36)], WHITE, faces=quads)
    one = prepare_coarse(box(WHITE, (3, 2, 2.5), without=("ceiling",)), elements=1000, patches=200).solve(UNIFORM)
    other = prepare_coarse(meshed, elements=1000, patches=200).solve(UNIFORM)
    assert len(other.faces_of("floor")) == 50 and len(np.unique(other.source_faces)) == 25
    for name in ("floor", "east", "south"):
        assert other.mean(name) == pytest.approx(one.mean(name), rel=2e-3)
    points, normals = [[1, 1, 0], [0.1, 0.2, 0], [0, 1, 1]], [[0, 0, 1], [0, 0, 1], [1, 0, 0]]
    np.testing.assert_allclose(
        other.at(points, normals, initial=True), one.at(points, normals, initial=True), rtol=1e-6
    )
    np.testing.assert_allclose(other.at(points, normals), one.at(points, normals), rtol=3e-3)


def reports_of(work):
    reports = []

    def progress(fraction, stage):
        reports.append((fraction, stage))
        return True

    work(progress)
    return reports


@pytest.mark.parametrize("threads", [1, 2])
def test_preparing_reports_its_way_from_nought_to_one(threads):
    reports = reports_of(lambda p: prepare_coarse(room(), progress=p, threads=threads))
    fractions = [f for f, _ in reports]
    assert fractions[0] == 0 and fractions[-1] == 1 and len(fractions) > 5
    assert (np.diff(fractions) >= 0).all()
    assert all(isinstance(stage, str) and stage for _, stage in reports)


@pytest.mark.parametrize("fraction", [0.0, 0.01, 0.02, 0.1, 0.5, 0.9, 1.0])
@pytest.mark.parametrize("threads", [1, 2])
def test_preparing_can_be_cancelled_anywhere(fraction, threads):
    scene, before = room(), threading.active_count()
    asked = []

    def progress(done, stage):
        asked.append(done)
        return done < fraction

    with pytest.raises(luz.Cancelled, match="Cancelled"):
        prepare_coarse(scene, progress=progress, threads=threads)
    assert asked[-1] >= fraction and all(f < fraction for f in asked[:-1]), "never asked again"
    assert threading.active_count() == before
    assert list(scene.surfaces) == list(room().surfaces)


def test_errors_of_the_callback_come_through():
    def progress(fraction, stage):
        if fraction > 0.1:
            raise KeyError("mine")
        return True

    with pytest.raises(KeyError, match="mine"):
        prepare_coarse(room(), progress=progress)


def test_a_callback_that_answers_nothing_goes_on():
    assert prepare_coarse(box(BLACK), progress=lambda fraction, stage: None).solve(DARK) is not None


def test_stages_are_recorded():
    stages = prepare_coarse(room()).stages
    ran = [s.name for s in stages if not s.skipped]
    assert ran == ["planes", "scene check", "fracture", "visibility and form factors"]
    assert all(s.seconds >= 0 for s in stages)
    assert "specular chains" not in {s.name for s in stages}
    assert prepare_coarse(box(BLACK)).stages[-1].skipped


@pytest.mark.parametrize("options", [{"max_area": 0.05}, {"max_area": 0.05, "bands": 60}, {"receivers": ["floor"]}])
def test_what_is_held_keeps_within_what_is_said(options):
    assert_within(prepare_coarse(room(), **options), 5.0)


def test_what_is_held_is_near_to_what_is_said_where_all_the_sky_is_seen():
    assert_within(prepare_coarse(scene_of({"ground": [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]]}, WHITE)), 1.2)


def assert_within(transfer, times):
    parts = (transfer, transfer.exchange, transfer.conservation)
    held = sum(value.nbytes for part in parts for value in vars(part).values() if isinstance(value, np.ndarray))
    held += sum(v.nbytes for sky in (transfer.sky_direct, transfer.sky_specular) for v in sky.packed().values())
    assert held <= 1.05 * bytes_held(transfer.geometry, len(transfer.nodes.points)) <= times * held


def test_receivers_that_are_added_keep_within_the_memory_too(monkeypatch):
    transfer = prepare_coarse(room())
    lattice, nodes = (len(n.points) for n in (transfer.lattice, transfer.nodes))
    monkeypatch.setattr(form_factors, "_ROOM", 1.0)
    assert nodes > lattice
    enough = bytes_held(transfer.geometry, nodes)
    prepare_coarse(room(), memory=enough)
    for short in (0.999 * enough, 0.999 * bytes_held(transfer.geometry, lattice)):
        with pytest.raises(luz.SceneError, match="receivers, more than"):
            prepare_coarse(room(), memory=short)


def test_memory_is_kept_to():
    """What is needed is said before the work starts, with the remedy."""
    begun = []
    with pytest.raises(
        luz.SceneError, match=r"needs \d+\.\d\d GB for \d+ receivers.*'memory'; raise max_area, lower bands"
    ):
        luz.prepare(room(), memory=1e6, progress=lambda f, s: begun.append(f) or True)
    assert max(begun) <= 0.02
    prepare_coarse(room(), memory=math.inf)
    prepare_coarse(room(), memory=1e9)


PLATE = {"plate": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]}


def on_a_plate(sky, bands):
    return prepare_coarse(scene_of(PLATE), bands=bands).solve(luz.Daylight(sky=sky)).illuminance[0]


@pytest.mark.parametrize("bands", [2, 3, 7, 8, 24, 60, 61])
def test_an_open_plane_under_an_even_sky_is_exact(bands):
    assert on_a_plate(luz.UniformSky(1000.0), bands) == pytest.approx(1000 * math.pi, rel=1e-6)


@pytest.mark.parametrize("bands", [24, 25, 61])
@pytest.mark.parametrize("normal", [(1, 0, 0), (0, -0.6, -0.8), (0.6, 0, 0.8)])
def test_sky_and_ground_part_at_the_horizon(normal, bands):
    """A plane tilted by β sees (1 + cos β) / 2 of an even sky and as much of the ground as is left."""
    result = prepare_coarse(scene_of(PLATE), bands=bands).solve(luz.Daylight(sky=luz.UniformSky(1000.0)))
    seen = result.at([[0.5, 0.5, 3.0]], [normal])[0]
    assert seen == pytest.approx(1000 * math.pi * (1 + normal[2]) / 2, rel=3e-4)


@pytest.mark.parametrize(
    "sky",
    [
        luz.CIESky(16, zenith_luminance=1000.0),
        luz.CIESky(12, sun_altitude=40, sun_azimuth=150, zenith_luminance=1000.0),
    ],
    ids=["overcast", "clear"],
)
def test_skies_err_with_the_square_of_the_bands(sky):
    errors = [abs(on_a_plate(sky, bands) / sky.horizontal_illuminance - 1) for bands in (15 * 2, 30 * 2, 60 * 2)]
    assert errors[1] < 3e-4
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.15)
    assert errors[1] / errors[2] == pytest.approx(4, rel=0.15)


@pytest.mark.parametrize("normal", [(1.0, 0.0, 0.0), (0.6, 0.0, -0.8)])
def test_skies_and_ground_on_a_tilted_plane_err_with_the_square_of_the_bands(normal):
    """The horizon crosses what the plane sees, of a sky that is bright there or dark, with ground below."""
    clear = luz.CIESky(12, sun_altitude=40, sun_azimuth=150, zenith_luminance=1000.0)
    for sky in (clear, luz.CIESky(16, zenith_luminance=1000.0)):
        light = luz.Daylight(sky=sky, ground_reflectance=0.3)
        far = {"far": np.array(PLATE["plate"]) - [0, 0, 1000]}
        bands = (16, 32, 64)
        found = [
            prepare_coarse(scene_of(far), bands=n).solve(light).at([[0.5, 0.5, 0]], [normal])[0] for n in (*bands, 256)
        ]
        errors = np.abs(np.array(found[:3]) / found[3] - 1)
        assert errors[2] < 2e-3
        assert (errors[:2] / errors[1:] > 3.4).all()


@pytest.mark.parametrize("name", ["bands", "max_area", "threads", "memory", "specular_cutoff"])
def test_options_are_keywords(name):
    with pytest.raises(TypeError):
        luz.prepare(box(BLACK), 24)
    assert name in luz.prepare.__kwdefaults__
