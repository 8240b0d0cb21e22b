"""Bad input: refused before work starts, by a message that names the thing and the remedy."""

import math

import numpy as np
import pytest
from builders import BLACK, UNIFORM, box, prepare_coarse, scene_of

import luzespecular as luz

FLOOR = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
PLATE = scene_of({"plate": FLOOR})


def test_one_family_of_errors():
    """SceneError is a ValueError for those who do not know the package; cancelling is no bad input."""
    assert issubclass(luz.SceneError, luz.LuzEspecularError) and issubclass(luz.SceneError, ValueError)
    assert issubclass(luz.Cancelled, luz.LuzEspecularError) and not issubclass(luz.Cancelled, ValueError)
    assert not issubclass(luz.LuzEspecularError, ValueError)


def test_an_empty_scene():
    with pytest.raises(luz.SceneError, match=r"no surfaces; add at least one with scene\.add"):
        luz.prepare(luz.Scene())


@pytest.mark.parametrize("scene", [None, {}, "room.blend", [FLOOR]])
def test_what_is_no_scene(scene):
    with pytest.raises(luz.SceneError, match=r"needs a luzespecular\.Scene, not"):
        luz.prepare(scene)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"bands": 1}, "bands must lie between 2 and 2000, not 1; 60 is usual"),
        ({"bands": 60.5}, r"bands must be a whole number .* not 60\.5"),
        ({"bands": "60"}, "bands must be a whole number"),
        ({"bands": True}, "bands must be a whole number"),
        ({"bands": 10**6}, "bands must lie between"),
        ({"max_area": 0}, "max_area must be above 0, not 0"),
        ({"max_area": -1}, "max_area must be above 0"),
        ({"max_area": math.nan}, "max_area must be above 0, not nan"),
        ({"max_area": "fine"}, "max_area must be a number, not 'fine'"),
        ({"max_area": [1, 2]}, "max_area must be a number"),
        ({"specular_cutoff": 0}, "specular_cutoff must be above 0"),
        ({"specular_cutoff": 2}, "specular_cutoff is 2; give a product of reflectances of at most 1"),
        ({"specular_cutoff": math.inf}, "specular_cutoff must be above 0, not inf"),
        ({"threads": 0}, "threads must be a whole number of at least 1, not 0"),
        ({"threads": 1.5}, "threads must be"),
        ({"threads": True}, "threads must be"),
        ({"memory": 0}, "memory must be above 0"),
        ({"memory": "1 GB"}, "memory must be a number"),
    ],
)
def test_options_of_prepare(options, message):
    asked = []
    with pytest.raises(luz.SceneError, match=message):
        luz.prepare(PLATE, progress=lambda f, s: asked.append(s) or True, **options)
    assert not asked, "refused before work starts"


@pytest.mark.parametrize(
    ("light", "options", "message"),
    [
        (None, {}, r"needs a luzespecular\.Daylight, not NoneType"),
        (luz.UniformSky(1000.0), {}, r"Daylight, not UniformSky; e\.g\. Daylight\(sky="),
        (UNIFORM, {"tolerance": 0}, "tolerance must lie between 0 and 1"),
        (UNIFORM, {"tolerance": 1}, "tolerance must lie between 0 and 1"),
        (UNIFORM, {"tolerance": math.nan}, "tolerance must lie between 0 and 1"),
        (UNIFORM, {"tolerance": "tight"}, "tolerance must be a number, not 'tight'"),
        (UNIFORM, {"tolerance": None}, "tolerance must be a number, not None"),
        (UNIFORM, {"cycles": -1}, "cycles must be a whole number of at least 0, or None for all, not -1"),
        (UNIFORM, {"cycles": 2.5}, "cycles must be"),
        (UNIFORM, {"cycles": True}, "cycles must be"),
        (UNIFORM, {"cycles": "5"}, "cycles must be"),
    ],
)
def test_options_of_solve(light, options, message):
    asked = []
    transfer = prepare_coarse(PLATE, bands=4)
    with pytest.raises(luz.SceneError, match=message):
        transfer.solve(light, progress=lambda f, s: asked.append(s) or True, **options)
    assert not asked, "refused before work starts"


@pytest.mark.parametrize(
    "material",
    [
        {"diffuse_reflectance": 0.6, "specular_reflectance": 0.5},
        {"diffuse_reflectance": 0.6, "regular_transmittance": 0.5},
        {"diffuse_reflectance": -0.1},
        {"diffuse_reflectance": 1.2},
        {"diffuse_reflectance": math.nan},
        {"specular_reflectance": math.inf},
        {"exitance": -1},
        {"diffuse_transmittance": 0.2},
    ],
    ids=str,
)
def test_materials_that_cannot_be(material):
    with pytest.raises(luz.SceneError, match="Material: "):
        luz.Material(**material)


@pytest.mark.parametrize("shares", [(0.3, 0.5, 0.2), (0.1, 0.2, 0.7)])
def test_materials_whose_shares_make_exactly_one(shares):
    luz.Material(diffuse_reflectance=shares[0], specular_reflectance=shares[1], regular_transmittance=shares[2])


@pytest.mark.parametrize("number", [math.nan, math.inf, -math.inf, 1e308])
def test_coordinates_that_are_none_name_surface_and_vertex(number):
    with pytest.raises(luz.SceneError, match="Surface 'wall': vertex 2 is"):
        luz.Scene().add("wall", [[0, 0, 0], [1, 0, 0], [1, number, 0], [0, 1, 0]], BLACK)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: luz.Sun(direction=(0, 0, 0), normal_illuminance=8e4), "(?i)direction"),
        (lambda: luz.Sun(direction=(0, math.nan, 1), normal_illuminance=8e4), "(?i)direction"),
        (lambda: luz.Sun(direction=(0, 0, 1), normal_illuminance=-1), "normal_illuminance"),
        (lambda: luz.CIESky(17, zenith_luminance=1.0), "17"),
        (lambda: luz.CIESky(12, zenith_luminance=1.0), "sun_altitude"),
        (lambda: luz.CIESky(5), "horizontal_illuminance"),
        (lambda: luz.UniformSky(-1), "luminance"),
        (lambda: luz.Daylight(sky="clear"), "sky"),
        (lambda: luz.Daylight(ground_reflectance=1.5), "ground_reflectance"),
    ],
)
def test_lights_that_cannot_be(make, message):
    with pytest.raises(luz.SceneError, match=message):
        make()


def test_a_concave_polygon_is_taken_for_what_it_is():
    """An L of 3 m² under an even sky: its own area, and the whole sky everywhere."""
    shape = [[0, 0, 0], [2, 0, 0], [2, 1, 0], [1, 1, 0], [1, 2, 0], [0, 2, 0]]
    result = prepare_coarse(scene_of({"L": shape})).solve(luz.Daylight(sky=luz.UniformSky(5000.0)))
    assert result.areas.sum() == pytest.approx(3, rel=1e-12)
    np.testing.assert_allclose(result.illuminance, 5000 * math.pi, rtol=1e-6)


def test_a_bow_tie_is_refused():
    with pytest.raises(luz.SceneError, match="Surface 'tie'"):
        luz.Scene().add("tie", [[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]], BLACK)


@pytest.mark.parametrize(("rho", "exitance"), [(0.0, 0.0), (0.9, 0.0)])
def test_one_triangle_is_a_scene(rho, exitance):
    scene = scene_of({"one": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}, luz.Material(diffuse_reflectance=rho))
    transfer = prepare_coarse(scene)
    light = luz.Daylight(sky=luz.UniformSky(5000.0))
    np.testing.assert_allclose(transfer.solve(light).illuminance, 5000 * math.pi, rtol=1e-6)


def test_what_is_not_finite_is_never_handed_out():
    """Should a number fail all the same, the surface is named instead of a result with holes."""
    transfer = prepare_coarse(box(BLACK, without=("ceiling",)))
    transfer.sky_direct.blocks[0].values[0] = np.nan
    with pytest.raises(ArithmeticError, match="Illuminance on 'floor' is not finite"):
        transfer.solve(UNIFORM)


def test_errors_leave_the_transfer_as_it_was():
    transfer = prepare_coarse(box(luz.Material(diffuse_reflectance=0.5), without=("ceiling",)))
    before = transfer.solve(UNIFORM).illuminance
    for bad in ({"tolerance": -1}, {"cycles": -1}):
        with pytest.raises(luz.SceneError):
            transfer.solve(UNIFORM, **bad)
    np.testing.assert_array_equal(transfer.solve(UNIFORM).illuminance, before)
