"""Enclosures: what is closed off from other light gets none of it, not even by rounding or by means over areas."""

import numpy as np
import pytest
from builders import BLACK, DARK, box_polygons, prepare_coarse

import luzespecular as luz
from luzespecular import preparation
from luzespecular.enclosures import APART, Enclosures, enclosed, keep_apart

GREY = luz.Material(diffuse_reflectance=0.5)


def test_parts_that_hardly_exchange_light():
    flux = np.zeros((9, 9))
    flux[:3, :3] = flux[3:6, 3:6] = 1.0
    flux[7, 8] = 1e-9  # little, but all that these have
    assert len(np.unique(enclosed(flux, np.ones(len(flux)))[[0, 3, 7]])) == 3
    for group in ([0, 1, 2], [3, 4, 5], [7, 8]):
        assert len(np.unique(enclosed(flux, np.ones(len(flux)))[group])) == 1
    assert enclosed(flux, np.ones(len(flux)))[6] == 0, "it sees nothing"
    flux[0, 5] = 30 * APART
    assert (enclosed(flux, np.ones(len(flux)))[:6] == 0).all()
    flux[0, 5] = 0.1 * APART
    assert len(np.unique(enclosed(flux, np.ones(len(flux)))[:6])) == 2


@pytest.mark.parametrize("seed", range(4))
def test_a_chain_of_rooms_is_one(seed):
    """Each patch sees but the next: partners of partners are of one part, in whatever order."""
    order = np.random.default_rng(seed).permutation(40)
    flux = np.zeros((40, 40))
    flux[order[:-1], order[1:]] = np.random.default_rng(seed).random(39) + 0.1
    assert (enclosed(flux, np.ones(len(flux))) == 0).all()
    assert len(enclosed(np.zeros((0, 0)), np.zeros(0))) == 0


def rooms(exitance, dim, apart=1.5, door=False):
    scene = luz.Scene()
    for title, own, size, origin in (
        ("bright", exitance, (1, 1, 1), (0, 0, 0)),
        ("dim", dim, (1.3, 2, 0.7), (apart, 0, 0)),
    ):
        for name, polygon in box_polygons(size, origin).items():
            if not (door and (title, name) in (("bright", "east"), ("dim", "west"))):
                material = luz.Material(diffuse_reflectance=0.5, exitance=own if name == "ceiling" else 0.0)
                scene.add(f"{title} {name}", polygon, material)
    return scene


def solved(scene):
    return prepare_coarse(scene, elements=400, patches=200, bands=40).solve(DARK, tolerance=1e-9)


def test_a_dim_room_beside_a_bright_one():
    """Lit 1e8 times less: what it gets through the bright one's edges is a matter of the globe alone."""
    together, alone = solved(rooms(5e4, 5e-4)), solved(rooms(0.0, 5e-4))
    assert together.transfer.conservation.enclosures.count == 2
    faces = [together.faces_of(f"dim {name}") for name in ("floor", "south", "east")]
    bright = together.mean("bright floor")
    for some, name in zip(faces, ("floor", "south", "east"), strict=True):
        leaked = together.illuminance[some] - alone.illuminance[alone.faces_of(f"dim {name}")]
        assert np.abs(leaked).mean() < 1e-4 * bright
    assert abs(together.balance.defect) < 1e-6
    dark = solved(rooms(5e4, 0.0))
    assert max(dark.mean(f"dim {name}") for name in ("floor", "south", "ceiling")) < 1e-4 * bright


def test_rooms_that_see_each_other_are_one():
    assert solved(rooms(5e4, 0.0, 1.0, door=True)).transfer.conservation.enclosures.count == 1


def test_many_lights_at_once_keep_apart_what_is_closed_off():
    """Two rooms with windows to either side of a wall: the years' lights agree with single ones."""
    scene = luz.Scene()
    for title, opened, origin in (("south", "south", (0, 0, 0)), ("north", "north", (0, 3, 0))):
        for name, polygon in box_polygons((2, 2, 2), origin).items():
            scene.add(f"{title} room's {name}", polygon, BLACK if name == opened else GREY)
    for title, origin in (("lit", (0, 20, 0)), ("other", (5, 20, 0))):
        for name, polygon in box_polygons((2, 2, 2), origin).items():
            if name != "north":
                scene.add(f"{title} {name}", polygon, GREY)
    transfer = prepare_coarse(scene, elements=600, patches=300, bands=30)
    assert transfer.conservation.enclosures.count >= 2
    lights = [
        luz.Daylight(sky=luz.UniformSky(1000.0)),
        luz.Daylight(sun=luz.Sun(altitude=30, azimuth=10, normal_illuminance=5e4)),
    ]
    many = transfer.solve_many(lights, sun_spacing=0)
    for light, got in zip(lights, many, strict=True):
        single = transfer.solve(light, tolerance=1e-7)
        for name in single.surfaces:
            faces = single.faces_of(name)
            expected = single.illuminance[faces] @ single.areas[faces]
            total = single.illuminance @ single.areas
            assert abs(got[faces] @ single.areas[faces] - expected) < 2e-3 * total


def test_they_go_with_a_saved_transfer(tmp_path):
    scene = rooms(5e4, 5e-4)
    transfer = prepare_coarse(scene, elements=200, patches=100, bands=8)
    path = transfer.save(tmp_path / "rooms")
    with pytest.MonkeyPatch.context() as patch:
        from luzespecular import fracture, geometry

        patch.setattr(fracture, "FEWEST_ELEMENTS", 200)
        patch.setattr(fracture, "ELEMENTS_PER_PLAIN_SURFACE", 20)
        patch.setattr(geometry, "PATCHES", 100)
        loaded = luz.load(path, scene)
    np.testing.assert_array_equal(loaded.solve(DARK).illuminance, transfer.solve(DARK).illuminance)


def parted(width, **filled):
    """Two boxes a little apart, with square holes of this width in the walls that face each other."""
    scene = luz.Scene()
    low, high = 0.4 - width / 2, 0.4 + width / 2
    square = np.array([[0.0, low, low], [0.0, high, low], [0.0, high, high], [0.0, low, high]])
    for title, x, faced in (("bright", 0.0, "east"), ("dim", 1.02, "west")):
        for name, polygon in box_polygons((1, 1, 1), (x, 0, 0)).items():
            glow = 5e4 if (title, name) == ("bright", "ceiling") else 0.0
            if width and name == faced:  # a ring, by a bridge
                hole = square[::-1] if name == "west" else square
                hole = np.add(hole, [polygon[0, 0], 0, 0])
                first = int(np.argmin(np.linalg.norm(hole - polygon[0], axis=1)))
                polygon = np.concatenate([polygon, polygon[:1], np.roll(hole, -first, axis=0), hole[[first]]])
            scene.add(f"{title} {name}", polygon, luz.Material(diffuse_reflectance=0.5, exitance=glow))
    for name, material in filled.items():
        scene.add(name, np.add(square, [1.01, 0, 0]), material)
    return scene


def dim_lux(scene, apart=True, **options):
    with pytest.MonkeyPatch.context() as patch:
        if not apart:
            patch.setattr(preparation, "keep_apart", lambda *_: None)
        result = prepare_coarse(scene, **{"elements": 400, "patches": 200, "bands": 30, **options}).solve(DARK)
    names = [f"dim {name}" for name in ("floor", "ceiling", "south", "north", "east")]
    return np.concatenate([result.illuminance[result.faces_of(name)] for name in names]), result


def test_nothing_leaks_into_what_is_closed_off():
    """Boxes that stand apart, where edges of both cross many beams."""
    for gap in (0.5, 0.03):
        scene = rooms(5e4, 0.0, 1 + gap)
        leaked, result = dim_lux(scene)
        assert result.transfer.conservation.enclosures.count == 2
        assert not leaked.any()
        sums = result.transfer.form_factors.sum(axis=1, dtype=float) + result.transfer.unlit
        np.testing.assert_allclose(sums, 1, atol=3e-6)
        assert not dim_lux(scene, apart=False)[0].any(), "nor is there anything to take out"


@pytest.mark.parametrize(("width", "pane", "sealed"), [(0.03, 0, False), (0.03, 0.9, False), (0, 0, True)])
def test_light_through_a_small_hole_or_pane_stays(width, pane, sealed):
    scene = parted(width, **({"pane": luz.Material(regular_transmittance=pane)} if pane else {}))
    transfer = prepare_coarse(scene, elements=400, patches=200, bands=30)
    geometry, nodes = transfer.geometry, transfer.nodes
    room = (geometry.element_points[:, 0] > 0).astype(np.int64)  # from the middle between both
    of_patches = np.zeros(geometry.targets.patches.count, np.int64)
    mine = geometry.targets.patches.of_element >= 0
    of_patches[geometry.targets.patches.of_element[mine]] = room[mine]
    parts = Enclosures(2, of_patches, room[nodes.element], room)
    factors = transfer.form_factors.copy()
    other = parts.of_nodes[:, None] != of_patches
    factors[np.argmax(other.any(axis=1)), np.argmax(other[np.argmax(other.any(axis=1))])] += 1e-4  # a leak
    before = factors.copy()
    assert keep_apart(geometry, nodes, parts, factors) == sealed
    if sealed:
        assert not factors[other].any()
        np.testing.assert_allclose(factors.sum(axis=1), before.sum(axis=1), rtol=1e-5)
    else:
        seen = (before > 0) & other
        assert np.count_nonzero(seen) > 100
        np.testing.assert_array_equal(factors, before)


def test_mirrors_leave_all_as_it_is():
    """Ways by these are not straight."""
    scene = rooms(5e4, 0.0)
    mirror = [[0.3, 0.1, 0.2], [0.7, 0.1, 0.2], [0.7, 0.1, 0.8], [0.3, 0.1, 0.8]]
    scene.add("mirror", mirror, luz.Material(specular_reflectance=0.8))
    np.testing.assert_array_equal(dim_lux(scene)[0], dim_lux(scene, apart=False)[0])
