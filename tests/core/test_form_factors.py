"""Form factors on nodes: means over patches and faces, receivers where light is uneven, and no lumen lost."""

import numpy as np
import pytest
from builders import BLACK, DARK, UNIFORM, box, prepare_coarse
from hypothesis import given, settings
from hypothesis import strategies as st
from layout_samples import triangle_rule

import luzespecular as luz
from luzespecular import fracture, layout
from luzespecular.form_factors import Conservation, Light, Rows, patch_means, trusted
from luzespecular.solve import gather_patches

WHITE = luz.Material(diffuse_reflectance=0.5)
CLEAR = luz.Daylight(sky=luz.CIESky(12, sun_altitude=40, sun_azimuth=0, horizontal_illuminance=10_000))


def coarse(scene, **options):
    return prepare_coarse(scene, **{"elements": 50, "max_area": 0.03, **options})


def room(**others):
    """Open to the north, with a two-sided screen."""
    scene = box(WHITE, (2, 1.5, 1), without=("north",), **others)
    scene.add("screen", [[0.6, 0.7, 0], [1.3, 0.7, 0], [1.3, 0.7, 0.55], [0.6, 0.7, 0.55]], WHITE, two_sided=True)
    return scene


@pytest.fixture(scope="module")
def open_room():
    return coarse(room(ceiling=luz.Material(specular_reflectance=0.8)))


@pytest.fixture(scope="module")
def closed_box():
    return coarse(box(WHITE, (2, 1.5, 1)))


def rows_of(transfer):
    """The rows that a transfer was made of."""
    deep = dict(zip(transfer.deep_rows.tolist(), transfer.deep_factors, strict=True))
    sky = transfer.sky_direct, transfer.sky_specular
    return Rows(transfer.form_factors, *sky, transfer.unlit, transfer.truncated, deep)


def kinds_of_light(transfer):
    return Light.of(transfer.geometry, rows_of(transfer), 0, len(transfer.unlit)).kinds()


def weights_of(nodes):
    """(e, m) float: the elements' weights, written out."""
    matrix = np.zeros((len(nodes.weights.start) - 1, len(nodes.points)))
    np.add.at(matrix, (nodes.weights.rows, nodes.weights.node), nodes.weights.weight)
    return matrix


@pytest.mark.parametrize("columns", [1, 7, None])
def test_means_over_patches_are_those_of_their_elements(open_room, columns):
    geometry, nodes = open_room.geometry, open_room.nodes
    assert len(nodes.points) != len(geometry.fracture.elements), "the nodes are not the elements"
    values = open_room.form_factors[:, :columns]
    on_elements = weights_of(nodes) @ values
    patch, area = geometry.targets.patches.of_element, geometry.fracture.element_areas
    got = patch_means(geometry, nodes, values)
    assert got.shape == (geometry.targets.patches.count, values.shape[1])
    for number in range(geometry.targets.patches.count):
        mine = patch == number
        np.testing.assert_allclose(
            got[number], np.average(on_elements[mine], axis=0, weights=area[mine]), rtol=1e-4, atol=1e-6
        )


def test_a_scene_without_patches_has_no_means():
    transfer = coarse(box(BLACK, without=("ceiling",)))
    assert transfer.exchange.factors.shape == (0, 0)
    assert (transfer.exchange @ np.zeros(0)).shape == (0,)


@pytest.mark.parametrize("name", ["open_room", "closed_box"])
def test_kinds_of_light_share_out_what_nodes_see(name, request):
    """Four blended sides of the sky make the whole; surfaces count by about how bright they will be."""
    transfer = request.getfixturevalue(name)
    kinds = kinds_of_light(transfer)
    assert (kinds >= 0).all() and len(kinds) == len(transfer.nodes.points)
    sky = transfer.sky_direct.dense().sum(axis=1, dtype=float) + transfer.sky_specular.dense().sum(axis=1)
    reflected = transfer.form_factors.sum(axis=1, dtype=float)
    share = 1.0 if name == "closed_box" else 0.2
    np.testing.assert_allclose(kinds[:, :4].sum(axis=1), sky, atol=1e-5)
    np.testing.assert_allclose(kinds.sum(axis=1), sky + share * reflected, atol=1e-5)


def test_sides_of_the_sky_are_told_apart(open_room):
    """The west wall sees the sky to the east and north of it."""
    kinds = kinds_of_light(open_room)[:, :4]
    surface = open_room.geometry.element_surface[open_room.nodes.element]
    names = open_room.geometry.planes.surfaces
    east, west, north, south = kinds[surface == names.index("west")].mean(axis=0)
    assert east > 1.3 * west and north > 1.3 * south
    east, west, _, _ = kinds[surface == names.index("east")].mean(axis=0)
    assert west > 1.3 * east


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_all_that_is_sent_in_a_closed_box_arrives(closed_box, seed):
    """Whatever the pattern of exitance."""
    geometry = closed_box.geometry
    patch, area = geometry.targets.patches.of_element, geometry.fracture.element_areas
    exitance = np.random.default_rng(seed).exponential(100.0, geometry.targets.patches.count) ** 2
    sent = float(area @ exitance[patch])
    got = float(area @ closed_box.nodes.weights.apply(gather_patches(closed_box, exitance, exact=True)))
    assert got == pytest.approx(sent, rel=1e-9)
    bare = float(area @ closed_box.nodes.weights.apply(closed_box.form_factors.astype(float) @ exitance))
    assert abs(bare / sent - 1) < 0.1, "little is made up for"
    means = closed_box.exchange @ exitance
    assert np.bincount(patch, weights=area) @ means == pytest.approx(sent, rel=1e-6), "patches lose nothing either"


def test_an_even_field_stays_as_it_is(closed_box):
    exitance = np.full(closed_box.geometry.targets.patches.count, 100.0)
    np.testing.assert_allclose(gather_patches(closed_box, exitance, exact=True), 100, rtol=1e-6)
    assert abs(closed_box.conservation.missing.sum()) < 1e-6 * np.abs(closed_box.conservation.missing).sum()


def test_what_is_missing_is_spread_by_what_receivers_see(open_room):
    """One lumen more makes one lumen; those who see the more of what the sky lights get the more of it."""
    conservation, geometry = open_room.conservation, open_room.geometry
    assert conservation.kept @ open_room.nodes.weights.apply(conservation.spread) == pytest.approx(1, rel=1e-6)
    sky = open_room.sky_direct.dense().sum(axis=1, dtype=float) + open_room.sky_specular.dense().sum(axis=1)
    lit = np.zeros(len(sky))
    for _ in range(12):
        on_elements = geometry.fracture.element_areas * open_room.nodes.on_elements(sky + lit)
        lit = open_room.form_factors @ (0.5 * geometry.patch_sums(on_elements) / geometry.patch_areas)
    np.testing.assert_allclose(conservation.spread, lit * (conservation.spread.sum() / lit.sum()), rtol=0.05)


def test_what_is_missing_without_sky_is_spread_by_the_surfaces_seen(closed_box):
    spread, seen = closed_box.conservation.spread, closed_box.form_factors.sum(axis=1, dtype=float)
    np.testing.assert_allclose(spread, seen * (spread.sum() / seen.sum()), rtol=1e-5)


def test_dark_ends_of_a_corridor_keep_their_light():
    """Far from its ends a corridor has a thousandth of the light there; faces have what points in them have."""
    scene = box(luz.Material(diffuse_reflectance=0.5), (1.8, 60, 2.6), without=("north", "south"))
    result = luz.prepare(scene, bands=30).solve(UNIFORM)
    middle = {name: result.faces_of(name) for name in ("floor", "ceiling", "west")}
    for name, faces in middle.items():
        faces = faces[np.argsort(np.abs(result.centroids[faces, 1] - 10))[:12]]
        there = result.at(result.centroids[faces], result.normals[faces])
        assert there.max() < 0.05 * result.illuminance.max(), name
        np.testing.assert_allclose(result.illuminance[faces], there, rtol=0.06, err_msg=name)
        assert np.mean(result.illuminance[faces] / there) == pytest.approx(1, abs=0.025), name


def test_what_escapes_is_known(open_room):
    """Of an element's light: through the opening, or, in the mirror ceiling, after it."""
    lost = open_room.conservation.lost
    names, surface = open_room.geometry.planes.surfaces, open_room.geometry.element_surface
    assert lost.min() > -0.01 and lost.max() < 1, lost.min()
    depth = open_room.geometry.element_points[:, 1] + open_room.geometry.planes.centre[1]
    floor = surface == names.index("floor")
    assert lost[floor & (depth > 1.4)].min() > 0.35 > 0.3 > lost[floor & (depth < 0.2)].max()


def test_kept_light_is_what_neither_mirrors_nor_panes_pass_on():
    scene = room(ceiling=luz.Material(specular_reflectance=0.8), west=luz.Material(regular_transmittance=0.7))
    transfer = coarse(scene)
    names, surface = transfer.geometry.planes.surfaces, transfer.geometry.element_surface
    share = transfer.conservation.kept / transfer.geometry.fracture.element_areas
    for name, expected in (("floor", 1.0), ("ceiling", 0.2), ("west", 0.3)):
        np.testing.assert_allclose(share[surface == names.index(name)], expected, err_msg=name)


def test_what_is_sent_is_trusted_where_little_escapes():
    lost = np.linspace(0, 1, 11)
    trust = trusted(lost)
    assert trust[0] == 1 and trust[-1] == 0 and trust[5] == pytest.approx(0.5)
    assert (np.diff(trust) < 0).all()
    assert trusted(0.01) > 0.999 and trusted(0.99) < 0.001
    np.testing.assert_array_equal(trusted(np.array([-1e-7, 1 + 1e-7])), [1, 0], err_msg="rounding does no harm")


def test_an_empty_row_of_conservation():
    """Nothing that reflects: nothing to spread, and no division by nothing."""
    transfer = coarse(box(BLACK, without=("ceiling",)))
    enclosures = transfer.conservation.enclosures
    conservation = Conservation.of(transfer.geometry, transfer.nodes, rows_of(transfer), enclosures)
    assert len(conservation.missing) == 0 and np.isfinite(conservation.spread).all()


def exact_means(result, faces, parts):
    """Mean over many points on each face, and the value at its centroid."""
    places = np.einsum("sk,fkc->fsc", triangle_rule(parts), result.vertices[faces])
    normals = np.repeat(result.normals[faces], parts**2, axis=0)
    values = result.at(places.reshape(-1, 3), normals).reshape(len(faces), -1)
    return values.mean(axis=1), result.at(result.centroids[faces], result.normals[faces])


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


@pytest.mark.parametrize("light", [UNIFORM, CLEAR], ids=["uniform", "clear"])
def test_faces_that_a_shelf_crosses_have_the_mean_of_both_sides(light):
    """Above the shelf it is twice as bright as below; its line cuts the faces in the middle of a cell."""
    scene = box(WHITE, (2, 1.5, 1), without=("ceiling",))
    scene.add("shelf", [[0, 0, 0.43], [2, 0, 0.43], [2, 0.5, 0.43], [0, 0.5, 0.43]], BLACK)
    result = coarse(scene, max_area=0.02).solve(light)
    south = result.faces_of("south")
    height = result.vertices[south][:, :, 2]
    crossed = south[(height.min(axis=1) < 0.43) & (height.max(axis=1) > 0.43)]
    assert len(crossed) >= 12
    mean, centroid = exact_means(result, crossed, 6)
    assert np.abs(centroid / mean - 1).max() > 0.2, "their centroids tell little"
    error = result.illuminance[crossed] / mean - 1
    assert rms(error) < 0.03 and np.abs(error).max() < 0.04


def test_faces_next_to_an_opening_have_the_mean_over_their_area():
    """In its corner, where two edges of the sky meet, one receiver for a face still errs by up to 3 %."""
    result = coarse(box(WHITE, (2, 1.5, 1), without=("north",)), max_area=0.02).solve(UNIFORM)
    beside = np.flatnonzero(result.vertices[:, :, 1].max(axis=1) > 1.5 - 1e-9)
    mean, _ = exact_means(result, beside, 4)
    error = np.abs(result.illuminance[beside] / mean - 1)
    assert len(beside) > 40
    assert rms(error) < 0.012 and error.max() < 0.035
    assert np.sort(error)[-len(error) // 20] < 0.02, "nineteen in twenty"


def test_receivers_are_added_where_a_shadow_has_an_edge():
    """Under a plate's rim the sky is cut off sharply: no lattice follows that, and `at` tells how it is."""
    scene = luz.Scene()
    scene.add("ground", [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]], WHITE)
    scene.add("plate", [[0.63, 0.55, 0.08], [0.63, 2.5, 0.08], [1.37, 2.5, 0.08], [1.37, 0.55, 0.08]], BLACK)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(layout, "_CLOSE", 0.0)  # as if the rim lay askew to the cells
        patch.setattr(fracture, "MOST_FINER", 0)
        transfer = coarse(scene, max_area=0.005)
    geometry, lattice, nodes = transfer.geometry, transfer.lattice, transfer.nodes
    assert len(nodes.points) > 1.2 * len(lattice.points)
    added = nodes.points[len(lattice.points) :] + geometry.planes.centre
    rim = np.minimum(np.abs(added[:, 0] - 0.63), np.abs(added[:, 0] - 1.37))
    rim = np.minimum(rim, np.abs(added[:, 1] - 0.55))
    ground = added[:, 2] < 0.04
    assert np.median(rim[ground]) < 0.2
    result = transfer.solve(UNIFORM, cycles=0)
    faces = result.faces_of("ground")
    exact = result.at(result.centroids[faces], result.normals[faces])
    open_ = np.pi * 1000
    first = np.pi * transfer.sky_direct.dense()[: len(lattice.points)].astype(float) @ result.sky
    by_lattice = geometry.fracture.side_means(lattice.on_elements(first))[faces]
    settled = rms((result.illuminance[faces] - exact) / open_)
    assert settled < 0.02
    assert settled < 0.6 * rms((by_lattice - exact) / open_)


def test_deep_rows_are_a_part_of_all():
    """Between two mirrors: what comes by many reflections is known apart, and no more than the whole."""
    mirror = luz.Material(specular_reflectance=0.9)
    walls = {name: mirror for name in ("west", "east", "south", "north")}
    transfer = coarse(box(WHITE, (1, 1, 1), **walls), bands=12, max_area=0.1)
    assert 0 < transfer.limits.exact_mirrors < 10
    assert len(transfer.deep_rows) == len(transfer.deep_factors) > 0
    whole = transfer.form_factors[transfer.deep_rows]
    assert (transfer.deep_factors <= whole + 1e-6).all() and (transfer.deep_factors >= 0).all()
    assert 0.02 < transfer.deep_factors.sum() / whole.sum() < 0.9
    none = coarse(box(WHITE, (1, 1, 1), west=mirror), bands=12, max_area=0.1)
    assert none.deep_factors.shape == (0, none.geometry.targets.patches.count)
    assert none.solve(DARK).illuminance.max() == 0
