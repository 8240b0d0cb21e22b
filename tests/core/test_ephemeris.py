"""The Sun from the Earth's centre."""

import numpy as np
import pytest

from luzespecular.ephemeris import apparent_sun, delta_t


def test_meeus_example():
    """Astronomical Algorithms, example 25.b: 1992 October 13 at 0 h TD: δ = -7°47'01.74″, R = 0.99760775."""
    days = np.array(2448908.5 - 2451545.0 - 58.7 / 86400)  # universal time lags 58.7 s behind
    sun = apparent_sun(days)
    assert np.degrees(sun.declination) == pytest.approx(-(7 + 47 / 60 + 1.74 / 3600), abs=5e-4)
    assert sun.distance == pytest.approx(0.99760775, abs=6e-5)


def test_perihelion_and_aphelion_of_2024():
    """3 January at 0:39 and 5 July at 5:06."""
    days = np.arange(8766.0, 9132.0)  # every noon of the year
    distance = apparent_sun(days).distance
    assert np.argmin(distance) in (1, 2) and distance.min() == pytest.approx(0.98331, abs=1e-4)
    assert np.argmax(distance) == 186 and distance.max() == pytest.approx(1.01673, abs=1e-4)


def test_delta_t():
    """Observed values (Astronomical Almanac), and the ends held beyond 1900 to 2100."""
    np.testing.assert_allclose(delta_t(np.array([1955.5, 1988.0, 2000.0, 2015.0])), [31.2, 55.8, 63.8, 67.9], atol=0.6)
    assert delta_t(1800.0) == delta_t(1900.0)
    assert delta_t(2300.0) == delta_t(2100.0)


def test_any_shape():
    days = np.linspace(-30000, 30000, 12)
    flat, folded = apparent_sun(days), apparent_sun(days.reshape(3, 4))
    for a, b in zip(flat, folded, strict=True):
        np.testing.assert_array_equal(a, b.ravel())
