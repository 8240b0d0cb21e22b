"""Materials: checked values, and the optics of a clear pane against closed forms."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from luzespecular.errors import SceneError
from luzespecular.materials import Material, inner_transmittance, normal_interface_reflectance, pane_optics

GLASS = 1.52
CLEAREST = (1 - normal_interface_reflectance(GLASS)) / (1 + normal_interface_reflectance(GLASS))
SHARES = ("diffuse_reflectance", "specular_reflectance", "regular_transmittance")
COSINES = st.floats(0.001, 1.0)


def test_everything_is_zero_by_default():
    assert dataclasses.asdict(Material()) == {
        "diffuse_reflectance": 0.0,
        "specular_reflectance": 0.0,
        "regular_transmittance": 0.0,
        "diffuse_transmittance": 0.0,
        "exitance": 0.0,
        "refractive_index": None,
    }
    assert not Material().is_specular and not Material().is_transparent


def test_values_are_keyword_only_and_frozen():
    with pytest.raises(TypeError):
        Material(0.5)
    with pytest.raises(dataclasses.FrozenInstanceError):
        Material().exitance = 1.0


@pytest.mark.parametrize("number", [1, 0.5, np.float32(0.5), np.int64(1)])
def test_every_real_number_is_taken_as_float(number):
    material = Material(diffuse_reflectance=number)
    assert type(material.diffuse_reflectance) is float
    assert material.diffuse_reflectance == float(number)


@pytest.mark.parametrize("shares", [(0.3, 0.5, 0.2), (0.1, 0.2, 0.7), (0.7, 0.2, 0.1), (1, 0, 0), (0, 1, 0), (0, 0, 1)])
def test_shares_may_add_up_to_one(shares):
    """0.1 + 0.2 + 0.7 is more than 1 in floating point; rounding refuses nobody."""
    Material(**dict(zip(SHARES, shares, strict=True)))


@pytest.mark.parametrize(
    ("given_", "message"),
    [
        ({"diffuse_reflectance": 0.6, "specular_reflectance": 0.5}, r"diffuse_reflectance \+ .* = 1\.1; lower"),
        ({"diffuse_reflectance": 0.6, "regular_transmittance": 0.5}, r"regular_transmittance = 1\.1; lower"),
        ({"specular_reflectance": 0.6, "regular_transmittance": 0.5}, r"= 1\.1; lower"),
        ({"diffuse_reflectance": 1 + 1e-9}, "diffuse_reflectance"),
        ({"diffuse_reflectance": -0.1}, r"diffuse_reflectance is -0\.1; it cannot be negative"),
        ({"specular_reflectance": -1e-9}, "specular_reflectance is -1e-09"),
        ({"regular_transmittance": -1}, "regular_transmittance is -1"),
        ({"exitance": -5}, "exitance is -5"),
        ({"diffuse_reflectance": 1.2}, r"diffuse_reflectance is 1\.2; give a share between 0 and 1"),
        ({"specular_reflectance": 90}, r"specular_reflectance is 90; .*not percent"),
        ({"diffuse_reflectance": math.nan}, "diffuse_reflectance must be a finite number, not nan"),
        ({"exitance": math.inf}, "exitance must be a finite number, not inf"),
        ({"diffuse_reflectance": None}, "diffuse_reflectance must be a number, not None"),
        ({"diffuse_reflectance": "white"}, "diffuse_reflectance must be a number, not 'white'"),
        (
            {"diffuse_reflectance": (0.5, 0.4, 0.3)},
            "diffuse_reflectance is given per colour channel, .* not available yet",
        ),
        ({"exitance": np.ones(3)}, "exitance is given per colour channel"),
        ({"diffuse_transmittance": 0.3}, "diffuse_transmittance .* not available yet"),
        ({"refractive_index": 1.0}, "refractive_index is 1; it must be above 1"),
        ({"refractive_index": math.nan}, "refractive_index must be a finite number, not nan"),
        ({"refractive_index": GLASS, "specular_reflectance": 0.1}, "leave out specular_reflectance"),
        ({"refractive_index": GLASS, "diffuse_reflectance": 0.1}, "refractive_index is for clear panes; leave out"),
        (
            {"refractive_index": GLASS, "regular_transmittance": CLEAREST + 1e-6},
            r"regular_transmittance 0\.918\d* is more than the 0\.9183 .* refractive index 1\.52",
        ),
    ],
)
def test_refusals_name_the_field(given_, message):
    with pytest.raises(SceneError, match="^Material: .*" + message):
        Material(**given_)


@pytest.mark.parametrize("value", ["0.5", True])
def test_texts_and_booleans_are_no_numbers(value):
    with pytest.raises(SceneError, match="diffuse_reflectance must be a number"):
        Material(diffuse_reflectance=value)


def test_the_clearest_pane_is_accepted():
    pane = Material(regular_transmittance=CLEAREST, refractive_index=GLASS)
    assert pane.is_specular and pane.is_transparent and pane.reflects_both_sides
    assert pane.specular_at(1.0) + pane.transmittance_at(1.0) == pytest.approx(1, abs=1e-9)


def test_without_an_index_nothing_depends_on_the_angle():
    cosines = np.array([[1.0, 0.5], [0.01, -0.3]])
    material = Material(specular_reflectance=0.2, regular_transmittance=0.7)
    np.testing.assert_array_equal(material.specular_at(cosines), np.full((2, 2), 0.2))
    np.testing.assert_array_equal(material.transmittance_at(cosines), np.full((2, 2), 0.7))
    assert not material.reflects_both_sides


@given(COSINES, st.floats(1.01, 4.0))
def test_a_pane_that_absorbs_nothing_loses_nothing(cosine, index):
    reflectance, transmittance = pane_optics(cosine, index, 1.0)
    assert reflectance + transmittance == pytest.approx(1, abs=1e-12)
    assert 0 < transmittance < 1


@given(COSINES, st.floats(1.01, 4.0), st.floats(0.0, 1.0))
def test_a_pane_never_gains(cosine, index, inner):
    reflectance, transmittance = pane_optics(cosine, index, inner)
    assert 0 <= transmittance <= 1 and 0 <= reflectance <= 1
    assert reflectance + transmittance <= 1 + 1e-12


@given(st.floats(1.01, 4.0), st.floats(1e-6, 1.0))
def test_inner_transmittance_undoes_the_normal_transmittance(index, inner):
    transmittance = float(pane_optics(1.0, index, inner)[1])
    assert inner_transmittance(transmittance, index) == pytest.approx(inner, rel=1e-9)


@given(st.floats(1.01, 3.0), st.floats(0.01, 1.0))
def test_the_pane_has_the_given_transmittance_at_normal_incidence(index, share):
    clearest = (1 - normal_interface_reflectance(index)) / (1 + normal_interface_reflectance(index))
    pane = Material(regular_transmittance=share * clearest, refractive_index=index)
    assert pane.transmittance_at(1.0) == pytest.approx(share * clearest, rel=1e-9)
    assert pane.transmittance_at(-1.0) == pane.transmittance_at(1.0)


def test_normal_incidence_in_closed_form():
    r = ((GLASS - 1) / (GLASS + 1)) ** 2
    assert normal_interface_reflectance(GLASS) == pytest.approx(r)
    reflectance, transmittance = pane_optics(1.0, GLASS, 1.0)
    assert reflectance == pytest.approx(2 * r / (1 + r), rel=1e-12)
    assert transmittance == pytest.approx((1 - r) / (1 + r), rel=1e-12)


def test_brewsters_angle():
    """There, light polarised in the plane of incidence is not reflected: the mean is half of the other's."""
    cosine = 1 / math.sqrt(1 + GLASS**2)
    reflectance, _ = pane_optics(cosine, GLASS, 1.0)
    one = ((GLASS**2 - 1) / (GLASS**2 + 1)) ** 2
    assert reflectance == pytest.approx(0.5 * 2 * one / (1 + one), rel=1e-12)


def test_at_grazing_incidence_everything_is_reflected():
    reflectance, transmittance = pane_optics(np.array([1e-3, 1e-6, 0.0]), GLASS, 0.97)
    assert (np.diff(reflectance) > 0).all()
    assert reflectance[-1] == pytest.approx(1, abs=1e-9)
    assert transmittance[-1] == pytest.approx(0, abs=1e-9)


def test_an_opaque_pane_reflects_at_its_first_interface_only():
    pane = Material(refractive_index=GLASS)
    assert pane.is_specular and not pane.is_transparent and not pane.reflects_both_sides
    assert pane.transmittance_at(0.3) == 0
    assert pane.specular_at(1.0) == pytest.approx(normal_interface_reflectance(GLASS))


def test_a_polarised_series_summed_by_hand():
    """Twenty inner reflections added one by one, at 60 degrees, with absorption."""
    inner, outside = 0.9, 0.5
    inside = math.sqrt(1 - 0.75 / GLASS**2)
    once = inner ** (1 / inside)
    expected = np.zeros(2)
    for r in (
        ((outside - GLASS * inside) / (outside + GLASS * inside)) ** 2,
        ((GLASS * outside - inside) / (GLASS * outside + inside)) ** 2,
    ):
        expected[0] += r / 2
        strength = (1 - r) / 2
        for crossing in range(20):
            strength *= once
            expected[(crossing + 1) % 2] += strength * (1 - r)
            strength *= r
    np.testing.assert_allclose(pane_optics(outside, GLASS, inner), expected, rtol=1e-12)
