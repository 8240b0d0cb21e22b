"""The globe of parcels against its geometry and exact integrals."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from luzespecular.errors import SceneError
from luzespecular.globe import Globe, direction_of

BANDS = [2, 3, 7, 24, 59, 60, 61, 180]
UNIT = st.tuples(st.floats(-1, 1), st.floats(0, 2 * math.pi)).map(
    lambda t: np.array([math.sqrt(1 - t[0] ** 2) * math.sin(t[1]), math.sqrt(1 - t[0] ** 2) * math.cos(t[1]), t[0]])
)


@pytest.fixture(scope="module", params=BANDS)
def globe(request):
    return Globe(request.param)


def test_sixty_bands_give_the_papers_number_of_parcels():
    assert Globe().bands == 60
    assert Globe().count == 5902


def test_solid_angles_sum_to_the_sphere(globe):
    assert globe.solid_angles.sum() == pytest.approx(4 * math.pi, rel=1e-13)
    assert (globe.solid_angles > 0).all()


def test_arrays_agree_on_the_number_of_parcels(globe):
    assert globe.count == globe.parcels_in_band.sum() == globe.band_starts[-1]
    assert len(globe.band_starts) == len(globe.polar_edges) == globe.bands + 1
    np.testing.assert_array_equal(np.bincount(globe.band_of), globe.parcels_in_band)
    assert (np.diff(globe.band_of) >= 0).all()
    assert globe.directions.shape == globe.first_moments.shape == (globe.count, 3)
    assert globe.half_widths.shape == (globe.count, 2)
    assert globe.axes.shape == (globe.count, 2, 3)


def test_zenith_and_nadir_are_alike(globe):
    np.testing.assert_array_equal(globe.parcels_in_band, globe.parcels_in_band[::-1])
    heights = np.sort(globe.directions[:, 2])
    np.testing.assert_allclose(heights, -heights[::-1], atol=1e-12)
    np.testing.assert_allclose(globe.solid_angles, globe.solid_angles[::-1], rtol=1e-9)


def test_solid_angles_are_nearly_equal():
    globe = Globe(60)
    mean = 4 * math.pi / globe.count
    away = globe.parcels_in_band[globe.band_of] > 10
    assert (np.abs(globe.solid_angles[away] / mean - 1) < 0.07).all()


def test_directions_and_axes_are_orthonormal(globe):
    frames = np.concatenate([globe.directions[:, None], globe.axes], axis=1)
    products = np.einsum("nac,nbc->nab", frames, frames)
    np.testing.assert_allclose(products, np.broadcast_to(np.eye(3), products.shape), atol=1e-12)


def test_azimuth_runs_clockwise_from_north():
    north, east, up = direction_of(np.radians([90, 90, 0]), np.radians([0, 90, 0]))
    np.testing.assert_allclose([north, east, up], [[0, 1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-15)


def test_first_moments_against_quadrature():
    globe = Globe(7)
    nodes, weights = np.polynomial.legendre.leggauss(24)
    for parcel in range(0, globe.count, 5):
        low, high = globe.polar_edges[globe.band_of[parcel] + np.array([0, 1])]
        polar = low + (high - low) * (nodes + 1) / 2
        azimuth = globe.azimuth[parcel] + globe.azimuth_width[parcel] * nodes / 2
        theta, phi = (x.ravel() for x in np.meshgrid(polar, azimuth, indexing="ij"))
        patch = np.outer(weights, weights).ravel() * (high - low) * globe.azimuth_width[parcel] / 4 * np.sin(theta)
        assert patch.sum() == pytest.approx(globe.solid_angles[parcel], rel=1e-12)
        np.testing.assert_allclose(globe.first_moments[parcel], patch @ direction_of(theta, phi), atol=1e-13)


def test_first_moments_of_the_upper_half_give_pi():
    globe = Globe(60)
    upper = globe.directions[:, 2] > 0
    np.testing.assert_allclose(globe.first_moments[upper].sum(axis=0), [0, 0, math.pi], atol=1e-12)
    np.testing.assert_allclose(globe.first_moments.sum(axis=0), 0, atol=1e-12)


def test_every_centre_lies_in_its_own_parcel(globe):
    np.testing.assert_array_equal(globe.parcel_of(globe.directions), np.arange(globe.count))


@given(UNIT, st.sampled_from(BANDS), st.floats(1e-6, 1e6))
def test_parcel_of_holds_the_direction(direction, bands, length):
    globe = Globe(bands)
    parcel = int(globe.parcel_of(direction * length))
    polar = math.atan2(math.hypot(direction[0], direction[1]), direction[2])
    low, high = globe.polar_edges[globe.band_of[parcel] + np.array([0, 1])]
    assert low - 1e-9 <= polar <= high + 1e-9
    if math.hypot(direction[0], direction[1]) > 1e-6:
        off = math.remainder(math.atan2(direction[0], direction[1]) - globe.azimuth[parcel], 2 * math.pi)
        assert abs(off) <= globe.azimuth_width[parcel] / 2 + 1e-9


def test_parcel_of_keeps_the_shape():
    globe = Globe(24)
    directions = np.stack([globe.directions[:6], globe.directions[6:12]]).reshape(2, 3, 2, 3)
    np.testing.assert_array_equal(globe.parcel_of(directions), np.arange(12).reshape(2, 3, 2))


def test_subdirections_fill_their_parcel_evenly(globe):
    some = np.arange(0, globe.count, max(1, globe.count // 500))
    parts = globe.subdirections(some, 4)
    assert parts.shape == (len(some), 16, 3)
    np.testing.assert_array_equal(globe.parcel_of(parts), np.repeat(some[:, None], 16, axis=1))
    fine = globe.subdirections(some, 16).mean(axis=1) * globe.solid_angles[some, None]
    np.testing.assert_allclose(fine, globe.first_moments[some], atol=4e-3 * globe.solid_angles.max())


@given(st.lists(UNIT, min_size=1, max_size=5), st.sampled_from([3, 24, 60]))
def test_interpolation_weights_sum_to_one_and_keep_to_their_side(directions, bands):
    globe = Globe(bands)
    directions = np.array(directions)
    parcels, weights = globe.interpolation(directions)
    assert parcels.shape == weights.shape == (len(directions), 4)
    np.testing.assert_allclose(weights.sum(axis=1), 1, atol=1e-12)
    above = directions[:, 2] >= 0
    middle = np.pi / globe.bands * (globe.band_of[parcels] + 0.5) - np.pi / 2
    assert (middle[above] <= 1e-9).all()
    assert (middle[~above] >= -1e-9).all()


@pytest.mark.parametrize("bands", [24, 60])
def test_interpolation_is_exact_at_centres(bands):
    globe = Globe(bands)
    parcels, weights = globe.interpolation(globe.directions)
    own = (weights * (parcels == np.arange(globe.count)[:, None])).sum(axis=1)
    np.testing.assert_allclose(own, 1, atol=1e-9)


@given(UNIT)
def test_interpolation_is_exact_for_functions_linear_in_height(direction):
    globe = Globe(60)
    parcels, weights = globe.interpolation(direction[None])
    polar = math.atan2(math.hypot(direction[0], direction[1]), direction[2])
    assert (weights * globe.polar[parcels]).sum() == pytest.approx(polar, abs=1e-9)


def test_interpolation_errs_with_the_square_of_the_width():
    rng = np.random.default_rng(1)
    directions = rng.normal(size=(4000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    directions = directions[np.abs(directions[:, 2]) < 0.9]

    def error(bands):
        globe = Globe(bands)
        parcels, weights = globe.interpolation(directions)
        got = (weights * np.exp(globe.directions @ [0.5, 1.0, 0.3])[parcels]).sum(axis=1)
        return np.sqrt(np.mean((got / np.exp(directions @ [0.5, 1.0, 0.3]) - 1) ** 2))

    assert error(60) < 1e-3
    assert error(30) / error(60) == pytest.approx(4, rel=0.25)


@given(UNIT, st.sampled_from([3, 24, 60]), st.floats(1e-3, 1e3))
def test_cosine_weights_of_any_plane_sum_to_one(normal, bands, length):
    half = Globe(bands).hemisphere(normal * length)
    assert half.weights.sum() == pytest.approx(1, abs=1e-12)
    assert (half.weights > 0).all()
    assert (half.directions @ half.normal > 0).all()
    assert np.linalg.norm(half.normal) == pytest.approx(1, abs=1e-12)
    assert len(np.unique(half.parcels)) == len(half.parcels)


@given(UNIT)
def test_cosine_weights_have_the_right_mean_direction(normal):
    """∫ d cos θ dω / π over a hemisphere is 2/3 of its normal."""
    half = Globe(60).hemisphere(normal)
    np.testing.assert_allclose(half.weights @ half.directions, 2 / 3 * half.normal, atol=2e-4)


@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, -1, 0)])
def test_planes_along_the_parcels_have_exact_weights(normal):
    globe = Globe(60)
    half = globe.hemisphere(normal)
    whole = np.abs(half.directions - globe.directions[half.parcels]).max(axis=1) < 1e-12
    exact = globe.first_moments[half.parcels] @ half.normal / math.pi
    np.testing.assert_allclose(half.weights[whole], exact[whole], rtol=1e-9)
    assert half.weights[whole].sum() > 0.99


@pytest.mark.parametrize(("asked", "got"), [(2, 2), (3, 4), (60, 60), (61, 62)])
def test_a_globe_cut_at_the_horizon(asked, got):
    globe = Globe.cut_at_horizon(asked)
    assert globe.bands == got
    assert np.abs(np.cos(globe.polar_edges)).min() < 1e-15
    with pytest.raises(SceneError, match="bands must"):
        Globe.cut_at_horizon(61.0)


@pytest.mark.parametrize("bands", [0, 1, -60, 2001, 60.0, 2.5, "60", True, None])
def test_bands_out_of_range(bands):
    with pytest.raises(SceneError, match="bands must"):
        Globe(bands)


@pytest.mark.parametrize("normal", [(0, 0, 1), (1, 0, 0), (0.3, -0.5, 0.8), (0, 0, -1)])
def test_outlines_of_parcels_weigh_what_they_should(normal):
    """Cosine-weighted areas on the tangent planes are the exact weights, but for these planes' distortion."""
    half = Globe(60).hemisphere(normal)
    weights = (half.shapes.moments * half.cosines).sum(axis=1) / math.pi
    assert weights.sum() == pytest.approx(1, abs=1e-3)
    np.testing.assert_allclose(weights[~half.odd], half.weights[~half.odd], rtol=7e-3)
    np.testing.assert_allclose(weights, half.weights, atol=2e-2 * half.weights.max())


def test_outlines_of_parcels_lie_above_the_plane():
    half = Globe(24).hemisphere([0.6, 0, 0.8])
    for shapes in (half.shapes, *half.fine_shapes):
        spatial = half.frames[:, :1] + np.einsum("avk,kac->kvc", shapes.corners, half.frames[:, 1:])
        some = shapes.moments[:, 0] > 1e-12  # of slivers there may be nothing left
        assert (spatial[some] @ half.normal > -1e-12).all()
        assert (shapes.counts <= shapes.corners.shape[1]).all()
        assert (shapes.moments[:, 0] > -1e-15).all(), "counter-clockwise"
    assert half.shapes.counts.min() == 4


def test_fine_outlines_are_the_parcels():
    """Their areas, but for the planes' distortion and what eight sides leave of an arc."""
    half = Globe(60).hemisphere([0, 0, 1])
    around, off = half.fine_shapes
    weights = ((around.moments - off.moments) * half.cosines).sum(axis=1) / math.pi
    np.testing.assert_allclose(weights, half.weights, rtol=5e-3)


@pytest.mark.parametrize("others", [24, 25, 60, 7])
def test_what_two_globes_have_in_common(others):
    """Every parcel is shared out wholly, among those that hold the directions in between."""
    one, other = Globe(24), Globe(others)
    own, theirs, solid_angle, direction = one.shared_with(other)
    for globe, parcels in ((one, own), (other, theirs)):
        sums = np.bincount(parcels, weights=solid_angle, minlength=globe.count)
        np.testing.assert_allclose(sums, globe.solid_angles, rtol=1e-9)
        wide = solid_angle > 1e-9
        np.testing.assert_array_equal(globe.parcel_of(direction[wide]), parcels[wide])
    assert (np.diff(own) >= 0).all() and one.shared_with(other)[0] is own, "found once"
