"""The lumen balance: what enters is absorbed, escapes, or is lost and said so."""

import math

import numpy as np
import pytest
from builders import BLACK, DARK, UNIFORM, box, box_polygons, flux, prepare_coarse, scene_of
from hypothesis import given, settings
from hypothesis import strategies as st

import luzespecular as luz

LIGHT = luz.Daylight(
    sky=luz.CIESky(12, sun_altitude=40, sun_azimuth=0, horizontal_illuminance=10_000),
    sun=luz.Sun(altitude=40, azimuth=0, normal_illuminance=80_000),
    ground_reflectance=0.2,
)


def total(balance):
    return sum(balance.absorbed.values()) + balance.escaped + balance.unlit + balance.truncated


@settings(max_examples=8, deadline=None)
@given(st.lists(st.floats(0, 0.95), min_size=6, max_size=6), st.lists(st.floats(0, 1000), min_size=6, max_size=6))
def test_all_lamplight_of_a_closed_box_is_absorbed(reflectances, exitances):
    scene = luz.Scene()
    for (name, polygon), rho, own in zip(box_polygons((2, 1.5, 1)).items(), reflectances, exitances, strict=True):
        scene.add(name, polygon, luz.Material(diffuse_reflectance=rho, exitance=own))
    result = prepare_coarse(scene, elements=300, patches=100).solve(DARK, tolerance=1e-7)
    balance = result.balance
    emitted = sum(
        own * result.areas[result.faces_of(name)].sum() for name, own in zip(result.surfaces, exitances, strict=True)
    )
    assert balance.entering == pytest.approx(emitted, abs=1e-9)
    assert balance.escaped == balance.unlit == balance.truncated == 0
    if emitted > 1e-6:
        assert abs(balance.defect) < 0.02
        assert sum(balance.absorbed.values()) == pytest.approx(emitted, rel=0.02)
    for name, rho in zip(result.surfaces, reflectances, strict=True):
        assert balance.absorbed[name] == pytest.approx((1 - rho) * flux(result, name), rel=1e-5, abs=1e-6)


def test_an_even_closed_box_closes_to_a_millionth():
    scene = box(luz.Material(diffuse_reflectance=0.9, exitance=100.0), (3, 2, 1.5))
    balance = prepare_coarse(scene).solve(DARK, tolerance=1e-8).balance
    assert abs(balance.defect) < 1e-6
    assert balance.entering == pytest.approx(100 * 27)


@pytest.mark.parametrize("rho", [0.0, 0.5, 0.9, 0.99, 0.999])
def test_a_closed_box_balances_exactly_however_white(rho, by_globe):
    """One bright side: what means over patches are out by is made up for, and told."""
    grey, lamp = luz.Material(diffuse_reflectance=rho), luz.Material(diffuse_reflectance=rho, exitance=100.0)
    transfer = prepare_coarse(box(grey, (3, 2, 1.5), ceiling=lamp), elements=50, max_area=0.05)
    balance = transfer.solve(DARK, tolerance=1e-9).balance
    assert abs(balance.defect) < 1e-9
    assert balance.entering == pytest.approx(600)
    assert sum(balance.absorbed.values()) == pytest.approx(600, rel=1e-9)
    assert 1e-5 < balance.adjusted < 0.02


L_SHAPE = np.array([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], float)
TETRAHEDRON = np.array([[1, 1, 1], [-1, -1, 1], [-1, 1, -1], [1, -1, -1]], float)


def closed_solid(name, material):
    scene = luz.Scene()
    if name == "tetrahedron":
        for k in range(4):
            corners = np.delete(TETRAHEDRON, k, axis=0)
            normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
            scene.add(f"side {k}", corners if normal @ corners[0] < 0 else corners[::-1], material)
        return scene
    floor = np.c_[L_SHAPE, np.zeros(6)]
    scene.add("floor", floor, material)
    up = np.array([0, 0, 1.2])
    scene.add("ceiling", floor[::-1] + up, material)
    for k, (a, b) in enumerate(zip(floor, np.roll(floor, -1, axis=0), strict=True)):
        scene.add(f"wall {k}", [a, a + up, b + up, b], material)
    return scene


@pytest.mark.parametrize("name", ["tetrahedron", "L-shaped room"])
@pytest.mark.parametrize("rho", [0.5, 0.999])
def test_even_light_in_closed_solids_stays_even(name, rho):
    """M / (1 - rho) at every face, and partial sums by cycles: what evens out the balance does not touch it."""
    scene = closed_solid(name, luz.Material(diffuse_reflectance=rho, exitance=100.0))
    transfer = prepare_coarse(scene, elements=100, max_area=0.1)
    result = transfer.solve(DARK, tolerance=1e-9)
    np.testing.assert_allclose(result.illuminance, 100 / (1 - rho), rtol=1e-6)
    assert abs(result.balance.defect) < 1e-9 and result.balance.adjusted < 1e-4
    np.testing.assert_allclose(
        transfer.solve(DARK, cycles=3).illuminance, 100 * sum(rho**k for k in range(4)), rtol=1e-6
    )


@pytest.mark.parametrize("rho", [0.3, 0.6, 0.9])
@pytest.mark.parametrize("light", [UNIFORM, LIGHT], ids=["uniform", "clear with Sun"])
def test_open_rooms_balance_to_a_thousandth(rho, light):
    """What is trusted the more, what stays or what escapes, leaves less than was out before."""
    transfer = prepare_coarse(
        box(luz.Material(diffuse_reflectance=rho), (3, 3, 3), without=("north",)), elements=50, max_area=0.1
    )
    balance = transfer.solve(light, tolerance=1e-7).balance
    assert abs(balance.defect) < 1e-3
    assert abs(balance.defect) < balance.adjusted < 0.02


@pytest.mark.parametrize(
    ("light", "escaped"),
    [
        (luz.Daylight(sun=luz.Sun(direction=(1, 2, 3), normal_illuminance=1e4)), 0.93132),
        (luz.Daylight(sky=luz.CIESky(12, sun_altitude=40, sun_azimuth=0, horizontal_illuminance=1e4)), 0.92926),
    ],
    ids=["Sun", "sky"],
)
def test_what_escapes_from_a_white_cloud_is_what_does_not_arrive(cloud, light, escaped):
    """Against 480,000 paths from the Sun or the sky, ± 0.0003."""
    balance = cloud.solve(light).balance
    assert abs(balance.defect) < 1e-4
    assert balance.escaped / balance.entering == pytest.approx(escaped, abs=2e-3)


@pytest.fixture(scope="module")
def cloud():
    """Forty triangles anyhow within a cube, white on both sides."""
    chance = np.random.default_rng(0)
    corners = chance.uniform(0, 1, (40, 1, 3)) + 0.2 * chance.normal(size=(40, 3, 3))
    scene, white = luz.Scene(), luz.Material(diffuse_reflectance=0.95)
    scene.add("cloud", corners.reshape(-1, 3), white, faces=np.arange(120).reshape(-1, 3), two_sided=True)
    return prepare_coarse(scene, elements=80, patches=60, bands=40)


def test_lamplight_adds_up_where_some_falls_on_dark_backs():
    """Few receivers: what they are out by is made up for as in closed rooms."""
    scene = box(luz.Material(diffuse_reflectance=0.7), (3, 2, 1.5))
    lamp = np.array([[1, 1.5, 0.5], [2, 1.5, 0.5], [2, 0.5, 0.5], [1, 0.5, 0.5]])
    scene.add("lamp", lamp, luz.Material(diffuse_reflectance=0.3, exitance=1e4))
    balance = prepare_coarse(scene, elements=80, patches=60).solve(DARK, tolerance=1e-8).balance
    assert balance.unlit > 0.01 * balance.entering
    assert abs(balance.escaped) < 1e-9 * balance.entering
    assert abs(balance.defect) < 1e-6


def test_nothing_is_made_up_for_where_nothing_is_reflected():
    balance = prepare_coarse(box(BLACK, without=("north",)), elements=50, max_area=0.05).solve(UNIFORM).balance
    assert balance.adjusted == 0


def test_daylight_of_an_open_room():
    """What lands enters; what is reflected out of the opening escapes."""
    result = prepare_coarse(
        box(luz.Material(diffuse_reflectance=0.5), (3, 3, 3), without=("north",)), elements=1000
    ).solve(LIGHT)
    balance = result.balance
    assert balance.entering == pytest.approx(result.initial @ result.areas, rel=1e-5)
    assert set(balance.absorbed) == set(result.surfaces)
    assert 0.05 * balance.entering < balance.escaped < 0.3 * balance.entering
    assert balance.unlit == balance.truncated == 0
    assert abs(balance.defect) < 2e-3
    assert total(balance) == pytest.approx(balance.entering, rel=2e-3)


def test_sun_through_a_window_is_counted_once(light_shelf):
    transfer = prepare_coarse(light_shelf.scene("S1"), elements=1500, patches=400, max_area=0.1)
    result = transfer.solve(light_shelf.daylight(12.0, sky=None))
    # absorbed by the mirror shelf (a tenth), and by what the rest of it lights
    assert result.balance.absorbed["shelf_top"] == pytest.approx(0.1 * flux(result, "shelf_top"), rel=1e-6)
    landed = {name: result.components["sun_direct"][result.faces_of(name)] for name in result.surfaces}
    landed = {name: float(lux @ result.areas[result.faces_of(name)]) for name, lux in landed.items()}
    ceiling = float((result.components["sun_specular"] * result.areas)[result.faces_of("ceiling")].sum())
    assert ceiling == pytest.approx(0.9 * landed["shelf_top"], rel=1e-9)
    expected = sum(landed.values()) - landed["shelf_top"] + 0.1 * landed["shelf_top"] + ceiling
    assert result.balance.entering == pytest.approx(expected, rel=1e-6)
    assert abs(result.balance.defect) < 0.02


def test_backs_swallow_light_and_it_is_said():
    """A wall of a box turned outwards: its black back takes what falls on it."""
    white = luz.Material(diffuse_reflectance=0.5, exitance=100)
    polygons = box_polygons()
    polygons["east"] = polygons["east"][::-1]
    result = prepare_coarse(scene_of(polygons, white), elements=600).solve(DARK)
    balance = result.balance
    assert balance.unlit > 0.1 * balance.entering
    assert balance.absorbed["east"] == 0
    # the turned wall shines and lands outside, where nothing is: its own light escapes
    assert balance.escaped == pytest.approx(100, rel=1e-3)
    assert abs(balance.defect) < 0.01


def test_two_sided_surfaces_absorb_on_both_sides():
    scene = box(BLACK, (2, 1, 1), east=luz.Material(exitance=100), west=luz.Material(exitance=300))
    grey = luz.Material(diffuse_reflectance=0.3)
    scene.add("screen", [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]], grey, two_sided=True)
    result = prepare_coarse(scene, elements=1500, patches=300).solve(DARK)
    faces = result.faces_of("screen")
    both = (result.illuminance[faces] + result.back.illuminance[faces]) @ result.areas[faces]
    assert result.balance.absorbed["screen"] == pytest.approx(0.7 * both, rel=1e-5)
    assert result.balance.entering == pytest.approx(400)
    assert abs(result.balance.defect) < 0.01


def test_mirrors_absorb_their_rest():
    scene = box(BLACK, floor=luz.Material(specular_reflectance=0.8), ceiling=luz.Material(exitance=1000))
    result = prepare_coarse(scene, elements=2000, patches=300).solve(DARK)
    balance = result.balance
    assert balance.absorbed["floor"] == pytest.approx(0.2 * flux(result, "floor"), rel=1e-5)
    assert balance.entering == pytest.approx(1000)
    assert abs(balance.defect) < 0.01


@pytest.mark.parametrize(("cutoff", "least", "most"), [(0.05, 0, 1e-6), (0.7, 0.005, 0.9)])
def test_chains_cut_off_are_booked(cutoff, least, most):
    """The deeper chains are followed, the less is cut; what is cut still closes the balance."""
    plates = box_polygons((4, 4, 1))
    scene = scene_of({k: plates[k] for k in ("floor", "ceiling")}, luz.Material(specular_reflectance=0.9))
    scene.add("lamp", [[1, 1, 0.5], [3, 1, 0.5], [3, 3, 0.5], [1, 3, 0.5]], luz.Material(exitance=1000))
    transfer = prepare_coarse(scene, elements=1000, patches=30, specular_cutoff=cutoff, bands=12)
    for light in (DARK, luz.Daylight(sun=luz.Sun(direction=(-1, 0, 1), normal_illuminance=1000.0))):
        balance = transfer.solve(light).balance
        assert least <= balance.truncated / balance.entering <= most
        assert abs(balance.defect) < 0.03


def test_no_light_no_lumens():
    result = prepare_coarse(box(luz.Material(diffuse_reflectance=0.5), without=("ceiling",))).solve(DARK)
    balance = result.balance
    assert balance.entering == balance.escaped == balance.unlit == balance.truncated == balance.defect == 0
    assert set(balance.absorbed.values()) == {0.0}


def test_the_balance_follows_the_cycles():
    """Cut after n reflections, what was still under way shows as the defect: in a closed even box, rho to the n + 1."""
    transfer = prepare_coarse(box(luz.Material(diffuse_reflectance=0.5, exitance=100.0)))
    for cycles in (0, 1, 4):
        balance = transfer.solve(DARK, cycles=cycles).balance
        assert balance.defect == pytest.approx(0.5 ** (cycles + 1), rel=1e-3)


def test_a_glass_roof_takes_its_share():
    glass = luz.Material(regular_transmittance=0.6)
    result = prepare_coarse(box(BLACK, ceiling=glass), elements=500).solve(UNIFORM)
    inside = sum(flux(result, name) for name in ("floor", "south", "north", "west", "east"))
    assert inside == pytest.approx(0.6 * math.pi * 1000, rel=0.01)
    assert np.isfinite(total(result.balance))


def test_sky_light_that_is_cut_counts_where_it_would_land():
    """Down a pipe of mirrors, all of what comes in lands or is cut; what mirrors only pass on is not counted."""
    polygons = {name: polygon for name, polygon in box_polygons((0.5, 0.5, 2.5)).items() if name != "ceiling"}
    scene = scene_of(polygons, luz.Material(specular_reflectance=0.95), floor=BLACK)
    balance = prepare_coarse(scene, elements=20, bands=30, specular_cutoff=0.5).solve(UNIFORM).balance
    entering = 1000 * math.pi * 0.25
    assert entering < sum(balance.absorbed.values()) + balance.truncated < 1.2 * entering
