"""What every sky keeps: the horizon, the exact integral, shapes, speed."""

import math

import numpy as np
import pytest
from sky_samples import ZENITH, clear, hemisphere, perez, some_directions, tregenza

from luzespecular.errors import SceneError
from luzespecular.sky import CIESky, MeasuredSky, Sky, UniformSky
from luzespecular.sky_model import horizontal_integral
from luzespecular.sun import direction_of

pytestmark = pytest.mark.filterwarnings("error")

SKIES = {
    "clear": clear,
    "overcast": lambda: CIESky(16, horizontal_illuminance=10_000.0),
    "uniform": lambda: UniformSky(1000.0),
    "perez": perez,
    "measured": lambda: MeasuredSky(tregenza(), clear().luminance(tregenza())),
}


@pytest.mark.parametrize("make", SKIES.values(), ids=SKIES)
def test_nothing_at_and_below_the_horizon(make):
    sky = make()
    assert isinstance(sky, Sky)
    below = some_directions() * [1, 1, -1]
    level = direction_of(np.zeros(36), np.arange(0, 360, 10))
    assert (sky.luminance(np.concatenate((below, level))) == 0.0).all()
    assert sky.luminance(direction_of(1e-9, 0.0)) > 0.0


@pytest.mark.parametrize("make", SKIES.values(), ids=SKIES)
def test_horizontal_illuminance_is_the_integral_of_the_luminance(make):
    sky = make()
    directions, solid = hemisphere(150)
    integral = float((sky.luminance(directions) * solid * directions[:, 2]).sum())
    assert sky.horizontal_illuminance == pytest.approx(integral, rel=1e-4)
    assert sky.zenith_luminance == pytest.approx(float(sky.luminance(ZENITH)[0]))


@pytest.mark.parametrize("make", SKIES.values(), ids=SKIES)
def test_shapes_of_directions(make):
    sky, directions = make(), some_directions(24)
    flat = sky.luminance(directions)
    assert flat.shape == (24,) and flat.dtype == np.float64
    np.testing.assert_allclose(sky.luminance(directions.reshape(4, 6, 3)), flat.reshape(4, 6))
    assert np.shape(sky.luminance(directions[0])) == ()
    assert sky.luminance(np.empty((0, 3))).shape == (0,)
    with pytest.raises(SceneError, match=r"\(n, 3\)"):
        sky.luminance(np.zeros((4, 2)))


def test_horizontal_integral_with_breaks_in_closed_form():
    """A sky that shines above sin γ = 0.3 only, and only within a radian of a Sun at the zenith."""
    band = horizontal_integral(lambda sines: np.where(sines > 0.3, 1.0, 0.0), gradation_breaks=(0.3,))
    assert band == pytest.approx(math.pi * (1 - 0.3**2), rel=1e-12)
    cap = horizontal_integral(
        np.ones_like, lambda angles: np.where(angles < 1.0, 1.0, 0.0), 90.0, indicatrix_breaks=(1.0,)
    )
    assert cap == pytest.approx(math.pi * math.sin(1.0) ** 2, rel=1e-12)
