"""False colours: the scales, their ranges and ticks, and what becomes of a value on its way to a corner."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st


@pytest.fixture(scope="module")
def colours():
    # Pure NumPy: no Blender is needed to test it.
    import importlib.util
    from pathlib import Path

    path = Path(__file__).resolve().parents[2] / "luzespecular_addon" / "colours.py"
    spec = importlib.util.spec_from_file_location("luzespecular_colours", path)
    module = importlib.util.module_from_spec(spec)
    import sys

    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def lightness(colours, srgb):
    """CIE 1976 lightness of sRGB colours."""
    y = colours.relative_luminance(colours.srgb_to_linear(srgb))
    return np.where(y > 216 / 24389, 116 * np.cbrt(y) - 16, y * 24389 / 27)


@pytest.mark.parametrize("name", ["VIRIDIS", "CIVIDIS", "INFERNO", "GREY"])
def test_perceptual_scales_grow_lighter_in_even_steps(colours, name):
    steps = np.diff(lightness(colours, colours.scale_colours(name, np.linspace(0, 1, 33))))
    assert (steps > 0).all()
    assert steps.max() < 2.0 * steps.mean()


def test_default_scale_is_safe_for_the_colour_blind(colours):
    # Machado, Oliveira & Fernandes (2009), full deuteranomaly and protanomaly: the order must stay readable.
    deuteranopia = np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    )
    protanopia = np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    )
    linear = colours.srgb_to_linear(colours.scale_colours(colours.names()[0], np.linspace(0, 1, 17)))
    for seen in (linear @ deuteranopia.T, linear @ protanopia.T):
        assert (np.diff(colours.relative_luminance(np.clip(seen, 0, 1))) > 0).all()


def test_spectrum_goes_from_blue_to_red(colours):
    low, high = colours.scale_colours("SPECTRUM", [0.0, 1.0])
    assert low[2] > low[0]
    assert high[0] > high[2]


# Matplotlib's own (3.11) scales at eleven even steps, sRGB.
MATPLOTLIB = {
    "VIRIDIS": "440154 482475 414487 355f8d 2a788e 21918c 22a884 44bf70 7ad151 bddf26 fde725",
    "CIVIDIS": "00224e 083370 35456c 4f576c 666970 7d7c78 948e77 aea371 c8b866 e5cf52 fee838",
    "INFERNO": "000004 160b39 420a68 6a176e 932667 bc3754 dd513a f37819 fca50a f6d746 fcffa4",
}


@pytest.mark.parametrize("name", list(MATPLOTLIB))
def test_scales_are_those_of_matplotlib(colours, name):
    theirs = [[int(colour[k : k + 2], 16) / 255 for k in (0, 2, 4)] for colour in MATPLOTLIB[name].split()]
    np.testing.assert_allclose(colours.scale_colours(name, np.linspace(0, 1, 11)), theirs, atol=0.035)


def test_srgb_is_decoded_by_the_standard(colours):
    np.testing.assert_allclose(
        colours.srgb_to_linear([0.0, 0.04045, 0.5, 1.0]), [0.0, 0.0031308, 0.2140411, 1.0], atol=1e-6
    )


def test_position_on_a_linear_and_a_logarithmic_scale(colours):
    linear = colours.ColourScale("GREY", 100.0, 300.0, False)
    logarithmic = colours.ColourScale("GREY", 10.0, 1000.0, True)
    np.testing.assert_allclose(linear.position([0, 100, 200, 300, 999]), [0, 0, 0.5, 1, 1])
    np.testing.assert_allclose(logarithmic.position([0, 10, 100, 1000, 1e6]), [0, 0, 0.5, 1, 1])
    assert np.isnan(logarithmic.position([np.nan])).all()


def test_corners_have_the_linear_colour_of_their_face(colours):
    scale = colours.ColourScale("SPECTRUM", 0.0, 100.0, False)
    made = colours.corner_colours([0.0, 50.0], [3, 5], scale)
    assert made.shape == (8, 4)
    assert (made[:, 3] == 1).all()
    np.testing.assert_allclose(made[:3, :3], np.tile(colours.srgb_to_linear(scale.srgb(0.0)), (3, 1)), rtol=1e-5)
    np.testing.assert_allclose(made[3:, :3], np.tile(colours.srgb_to_linear(scale.srgb(50.0)), (5, 1)), atol=1e-3)


@pytest.mark.parametrize("name", ["VIRIDIS", "CIVIDIS", "INFERNO", "SPECTRUM", "GREY"])
def test_not_computed_is_no_colour_of_the_scale_and_not_flat(colours, name):
    scale = colours.ColourScale(name, 0.0, 100.0, False)
    for corners in (3, 4):
        made = colours.corner_colours([np.nan], [corners], scale)
        assert len({tuple(colour) for colour in made.tolist()}) == 2
    assert not np.isnan(made).any()


@given(
    low=st.floats(1e-3, 1e5),
    ratio=st.floats(1.001, 1e6),
    logarithmic=st.booleans(),
)
def test_automatic_range_holds_the_values(colours, low, ratio, logarithmic):
    values = np.geomspace(low, low * ratio, 50)
    start, end = colours.automatic_range(values, np.ones(50), logarithmic)
    assert start < end
    if logarithmic:
        assert 0 < start
        assert end >= values.max() * (1 - 1e-6)
        assert start >= end * colours.LOWEST_SHARE * 0.99 / 10
    else:
        assert start == 0
        assert end >= np.median(values)


def test_a_small_sun_patch_does_not_take_the_linear_scale(colours):
    values = np.append(np.full(99, 400.0), 80_000.0)
    assert colours.automatic_range(values, np.ones(100), False) == (0.0, 500.0)
    assert colours.automatic_range(values, np.ones(100), True) == (200.0, 100_000.0)


@pytest.mark.parametrize("values", [[], [np.nan, np.nan], [0.0, 0.0]])
@pytest.mark.parametrize("logarithmic", [False, True])
def test_darkness_has_a_range_too(colours, values, logarithmic):
    low, high = colours.automatic_range(values, np.ones(len(values)), logarithmic)
    assert low < high
    assert not logarithmic or low > 0


@pytest.mark.parametrize("logarithmic", [False, True])
def test_ends_that_blender_has_stored_keep_their_ticks(colours, logarithmic):
    low, high = (float(np.float32(end)) for end in (0.05, 0.7))
    ticks = colours.ColourScale("VIRIDIS", low, high, logarithmic).ticks()
    assert ticks[0] == pytest.approx(0.05 if logarithmic else 0.1)
    assert ticks[-1] == pytest.approx(0.5 if logarithmic else 0.7)


def test_legends_tell_their_ends(addon):
    def told(low, high, logarithmic=True):
        return addon.legend.entries(addon.colours.ColourScale("VIRIDIS", low, high, logarithmic))

    found = told(200.0, 100_000.0)
    assert found[0] == (0.0, "200") and found[1][1] == "500" and found[-1] == (1.0, "100 000")
    assert [text for _, text in told(137.0, 1050.0)] == ["137", "200", "500", "1 000"]  # 1050 has no room
    found = told(130.0, 770.0, False)
    assert found[0] == (0.0, "130") and found[-1] == (1.0, "770")
    assert all(after[0] - before[0] > 0.05 for before, after in pairwise(found))
    assert [text for _, text in told(0.0, 500.0, False)] == ["0", "100", "200", "300", "400", "500"]


@given(low=st.floats(1e-2, 1e4), ratio=st.floats(1.01, 1e5), logarithmic=st.booleans())
def test_ticks_are_few_round_and_inside(colours, low, ratio, logarithmic):
    scale = colours.ColourScale("GREY", low if logarithmic else 0.0, low * ratio, logarithmic)
    ticks = scale.ticks()
    assert 2 <= len(ticks) <= 8
    assert (np.diff(ticks) > 0).all()
    assert ticks[0] >= scale.low * (1 - 1e-6)
    assert ticks[-1] <= scale.high * (1 + 1e-6)
