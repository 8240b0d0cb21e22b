"""Many lights at once: the same as one by one, within what the Sun's positions and patches err by."""

import numpy as np
import pytest
from builders import BLACK, box, prepare_coarse
from hypothesis import given, settings
from hypothesis import strategies as st

import luzespecular as luz
from luzespecular import block
from luzespecular.block import Lights

WHITE = luz.Material(diffuse_reflectance=0.5)
MIRROR = luz.Material(specular_reflectance=0.8)
LAMP = luz.Material(diffuse_reflectance=0.5, exitance=300.0)
DESKS = [[1.5, 1.0, 0.8], [0.5, 0.5, 0.8], [1.0, 1.5, 1.2]], [[0, 0, 1], [0, 0, 1], [0, -1, 0.5]]


def room(**others):
    scene = box(WHITE, (3, 2, 2.5), without=("north",), **{"ceiling": MIRROR, "west": LAMP, **others})
    scene.add("screen", [[1, 1.5, 0], [2, 1.5, 0], [2, 1.5, 1.2], [1, 1.5, 1.2]], others.get("screen", WHITE))
    return scene


def clear(altitude, azimuth=10.0, sun=60_000.0, ground=0.2):
    return luz.Daylight(
        sky=luz.CIESky(12, sun_altitude=altitude, sun_azimuth=azimuth, horizontal_illuminance=9_000),
        sun=luz.Sun(altitude=altitude, azimuth=azimuth, normal_illuminance=sun) if sun else None,
        ground_reflectance=ground,
    )


OVERCAST = luz.Daylight(sky=luz.CIESky(16, horizontal_illuminance=12_000), ground_reflectance=0.1)
NIGHT = luz.Daylight(sun=luz.Sun(altitude=-5, azimuth=0, normal_illuminance=80_000))


@pytest.fixture(scope="module")
def transfer():
    return prepare_coarse(room(), max_area=0.1)


def one_by_one(transfer, lights):
    return np.array([transfer.solve(light).illuminance for light in lights])


def test_skies_give_what_they_give_alone(transfer):
    lights = [OVERCAST, clear(30, sun=0), clear(60, 200, sun=0), luz.Daylight(sky=luz.UniformSky(1000))]
    alone, found = one_by_one(transfer, lights), transfer.solve_many(lights)
    assert found.dtype == np.float32 and found.shape == alone.shape
    np.testing.assert_allclose(found, alone, rtol=2e-3)
    np.testing.assert_allclose(found.mean(axis=1), alone.mean(axis=1), rtol=2e-4)


def test_the_suns_own_positions_are_exact_where_nothing_is_reflected():
    black = prepare_coarse(room(west=BLACK, floor=BLACK, south=BLACK, east=BLACK, screen=BLACK), max_area=0.1)
    lights = [clear(30), clear(55, 350), clear(5, 60)]
    found = black.solve_many(lights, sun_spacing=0)
    np.testing.assert_allclose(found, one_by_one(black, lights), rtol=1e-3, atol=0.1)


def test_reflected_sunlight_goes_by_patches(transfer):
    lights = [clear(30), clear(55, 350), clear(12, 40)]
    alone, found = one_by_one(transfer, lights), transfer.solve_many(lights, sun_spacing=0)
    areas = transfer.geometry.fracture.face_areas
    np.testing.assert_allclose(found @ areas, alone @ areas, rtol=2e-3)
    assert np.median(np.abs(found / alone - 1)) < 0.01


def test_lumens_hold_between_the_suns_positions(transfer):
    lights = [clear(31.3), clear(44.7, 351)]
    areas = transfer.geometry.fracture.face_areas
    found = transfer.solve_many(lights, sun_spacing=4)
    np.testing.assert_allclose(found @ areas, one_by_one(transfer, lights) @ areas, rtol=0.03)


@settings(max_examples=60, deadline=None)
@given(st.floats(0.01, 90), st.floats(0, 360), st.sampled_from([0.0, 1.0, 3.0, 7.0, 30.0]))
def test_positions_around_the_sun_share_its_light(altitude, azimuth, spacing):
    sun = luz.Sun(altitude=altitude, azimuth=azimuth, normal_illuminance=50_000)
    lights = Lights.of([None, luz.Daylight(sun=sun)], spacing)
    assert lights.share[1].sum() == pytest.approx(50_000)
    assert (lights.share >= 0).all() and not lights.share[0].any()
    assert (lights.suns[:, 2] > 0).all()
    np.testing.assert_allclose(np.linalg.norm(lights.suns, axis=1), 1)
    near = lights.suns[lights.position[1][lights.share[1] > 0]]
    apart = np.degrees(np.arccos(np.clip(near @ np.array(sun.direction), -1, 1)))
    assert apart.max() <= max(1e-5, 1.6 * spacing) or altitude > 90 - 2 * spacing


def test_lights_stay_in_their_order(transfer):
    lights = [clear(31.3), None, clear(44.7, 351), clear(12.0, 20), clear(31.3), luz.Daylight()]
    found = transfer.solve_many(lights)
    for light, lux in zip(lights, found, strict=True):
        np.testing.assert_allclose(lux, transfer.solve_many([light])[0], rtol=1e-4, atol=1e-3)
    backwards = transfer.solve_many(lights[::-1])[::-1]
    np.testing.assert_allclose(backwards, found, rtol=1e-5, atol=1e-3)


def test_the_dark_leaves_luminous_surfaces(transfer):
    found = transfer.solve_many([None, NIGHT, luz.Daylight()])
    alone = transfer.solve(luz.Daylight()).illuminance
    assert alone.min() > 0
    np.testing.assert_allclose(found, np.tile(alone, (3, 1)), rtol=1e-6)


def test_points_get_what_they_get_alone(transfer):
    lights = [OVERCAST, clear(40, sun=0), None]
    found = transfer.solve_many(lights, points=DESKS[0], normals=DESKS[1])
    alone = np.array([transfer.solve(light or luz.Daylight()).at(*DESKS) for light in lights])
    np.testing.assert_allclose(found, alone, rtol=3e-3)
    sunny = transfer.solve_many([clear(40)], points=DESKS[0], normals=DESKS[1], sun_spacing=0)
    np.testing.assert_allclose(sunny[0], transfer.solve(clear(40)).at(*DESKS), rtol=0.03)


def test_light_adds_up_and_order_does_not_matter(transfer):
    lights = [OVERCAST, clear(30), None, clear(50, 340)]
    whole = transfer.solve_many(lights)
    np.testing.assert_allclose(transfer.solve_many(lights[::-1])[::-1], whole, rtol=1e-5)
    np.testing.assert_allclose(transfer.solve_many(lights[1:2])[0], whole[1], rtol=1e-5)
    no_sky = transfer.solve_many([luz.Daylight(sun=lights[1].sun)])[0]
    no_sun = transfer.solve_many([luz.Daylight(sky=lights[1].sky)])[0]
    ground = transfer.solve_many([luz.Daylight(sun=lights[1].sun, sky=lights[1].sky, ground_reflectance=0.2)])[0]
    dark = whole[2]
    np.testing.assert_allclose(
        no_sky
        + no_sun
        - dark
        + (ground - transfer.solve_many([luz.Daylight(sun=lights[1].sun, sky=lights[1].sky)])[0]),
        whole[1],
        rtol=1e-4,
    )


def test_pieces_make_the_whole(transfer, monkeypatch):
    lights = [OVERCAST, clear(30), None]
    whole = transfer.solve_many(lights)
    monkeypatch.setattr(block, "_BLOCK_BYTES", 2e4)
    np.testing.assert_allclose(transfer.solve_many(lights), whole, rtol=1e-5)


@settings(max_examples=8, deadline=None)
@given(st.floats(0.02, 0.95), st.floats(5, 80), st.floats(0, 360), st.sampled_from([20, 60, 300]))
def test_nothing_is_negative_however_coarse(reflectance, altitude, azimuth, elements):
    """Where more light arrives than was sent, what is taken away again is no more than there is, as with one light."""
    pale, dark = luz.Material(diffuse_reflectance=0.95), luz.Material(diffuse_reflectance=reflectance)
    scene = room(floor=pale, screen=dark, west=dark)
    coarse = prepare_coarse(scene, elements=elements, patches=8, bands=6)
    skies = [clear(altitude, azimuth, sun) for sun in (60_000.0, 0.0)]
    suns = [luz.Daylight(sun=luz.Sun(altitude=altitude, azimuth=azimuth, normal_illuminance=60_000.0))]
    for lux in (coarse.solve_many([*skies, *suns, NIGHT]), coarse.solve_many(suns, points=DESKS[0], normals=DESKS[1])):
        assert np.isfinite(lux).all() and lux.min() >= 0
    alone = coarse.solve(skies[1])
    together = coarse.solve_many([skies[1]])[0]
    assert together @ alone.areas == pytest.approx(alone.illuminance @ alone.areas, rel=0.02)


def test_no_lights_no_rows(transfer):
    assert transfer.solve_many([]).shape == (0, len(transfer.geometry.fracture.faces))


def test_closed_rooms_look_at_no_sky():
    closed = prepare_coarse(box(WHITE, west=LAMP))
    found = closed.solve_many([clear(40), None], sun_spacing=0)
    np.testing.assert_allclose(found[0], closed.solve(luz.Daylight()).illuminance, rtol=1e-4)
    names = {stage.name: stage.skipped for stage in closed.annual([OVERCAST]).stages}
    assert names["sky"] == "nothing sees the sky"
    assert names["sun"] == "no Sun is up"


def test_black_rooms_have_nothing_to_reflect():
    black = prepare_coarse(box(BLACK, without=("north",)))
    np.testing.assert_allclose(black.solve_many([OVERCAST])[0], black.solve(OVERCAST).illuminance, rtol=1e-3)


def test_light_without_end_is_refused():
    white = prepare_coarse(box(luz.Material(diffuse_reflectance=1.0), west=luz.Material(diffuse_reflectance=1.0)))
    with pytest.raises(luz.SceneError, match="without end"):
        white.solve_many([luz.Daylight(sun=luz.Sun(altitude=30, azimuth=0, normal_illuminance=1.0))])


@pytest.mark.parametrize(
    "lights, options, message",
    [
        ([OVERCAST, "noon"], {}, "Light 1 must be"),
        ([OVERCAST], {"sun_spacing": -1}, "sun_spacing is -1"),
        ([OVERCAST], {"sun_spacing": "fine"}, "sun_spacing must be a number"),
        ([OVERCAST], {"memory": 0}, "memory must be above 0"),
        ([OVERCAST], {"memory": 1e6}, "more than the 0.00 GB of 'memory'"),
        ([OVERCAST], {"points": [[0, 0, 1]]}, "both must be"),
        ([OVERCAST], {"points": [[0, 0, 1]], "normals": [[0, 0, 0]]}, "not zero"),
    ],
)
def test_bad_input_is_refused(transfer, lights, options, message):
    with pytest.raises(luz.SceneError, match=message):
        transfer.solve_many(lights, **options)


def test_progress_rises_and_cancels(transfer):
    seen = []
    transfer.solve_many([clear(30), OVERCAST], progress=lambda share, name: seen.append(share) or True)
    assert seen == sorted(seen) and 0 <= seen[0] and seen[-1] <= 1
    with pytest.raises(luz.Cancelled):
        transfer.solve_many([clear(30)], progress=lambda share, name: share < 0.3)
