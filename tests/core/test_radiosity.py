"""Interreflection: cycles and their limit against dense linear algebra, and closed rooms in closed form."""

import numpy as np
import pytest
from builders import DARK, UNIFORM, box, prepare_coarse
from hypothesis import given, settings
from hypothesis import strategies as st

import luzespecular as luz
from luzespecular import radiosity
from luzespecular.errors import Cancelled, SceneError


def closed_factors(count, seed=0):
    """Form factors of a closed room of unequal patches: rows sum to one, area times factor is symmetric."""
    rng = np.random.default_rng(seed)
    exchange = rng.uniform(0.1, 1, (count, count))
    exchange = exchange + exchange.T
    area = exchange.sum(axis=1)
    return exchange / area[:, None], area


SYSTEMS = st.tuples(st.integers(1, 12), st.integers(0, 1000), st.floats(0.0, 0.99), st.floats(0.3, 1.0))


def system(count, seed, top, openness):
    factors, _ = closed_factors(count, seed)
    rng = np.random.default_rng(seed + 1)
    return factors * openness, rng.uniform(0, top, count), rng.uniform(0, 1000, count)


def exact(factors, reflectance, initial):
    return np.linalg.solve(np.eye(len(initial)) - factors * reflectance, initial)


@given(SYSTEMS, st.integers(0, 8))
def test_cycles_are_the_partial_sums(given_, cycles):
    factors, reflectance, initial = system(*given_)
    expected = sum(np.linalg.matrix_power(factors * reflectance, k) @ initial for k in range(cycles + 1))
    np.testing.assert_allclose(radiosity.by_cycles(factors, reflectance, initial, cycles), expected, rtol=1e-10)


@given(SYSTEMS)
def test_the_limit_is_the_solution_of_the_system(given_):
    factors, reflectance, initial = system(*given_)
    got = radiosity.until_settled(factors, reflectance, initial, 1e-9)
    np.testing.assert_allclose(got, exact(factors, reflectance, initial), rtol=1e-6, atol=1e-6 * initial.max())


@given(SYSTEMS, st.sampled_from([1e-2, 1e-4, 1e-6]))
def test_what_is_left_to_come_is_below_the_tolerance(given_, tolerance):
    """Relative to the mean of the whole field, and never reached by stopping early where the light lasts long."""
    factors, reflectance, initial = system(*given_)
    if not initial.any():
        return
    got = radiosity.until_settled(factors, reflectance, initial, tolerance)
    right = exact(factors, reflectance, initial)
    assert np.linalg.norm(got - right) <= 2 * tolerance * np.linalg.norm(right)


@pytest.mark.parametrize("reflectance", [0.0, 0.5, 0.95, 0.99, 0.999, 0.9999])
def test_an_even_field_in_a_closed_room(reflectance):
    factors, _ = closed_factors(50)
    got = radiosity.until_settled(factors, np.full(50, reflectance), np.full(50, 100.0), 1e-6)
    np.testing.assert_allclose(got, 100 / (1 - reflectance), rtol=1e-6)


@pytest.mark.parametrize("times", [1e-100, 1e-30, 1e15, 1e30, 1e100])
def test_light_of_any_size_settles_alike(times):
    """What counts as rounding is measured by steps of unit length, not by the light."""
    factors, reflectance, initial = system(12, 5, 0.97, 1.0)
    one, many = (radiosity.until_settled(factors, reflectance, t * initial, 1e-9) for t in (1.0, times))
    np.testing.assert_allclose(many / times, one, rtol=1e-12)


def test_near_white_rooms_settle_in_few_steps():
    factors, area = closed_factors(200, 3)
    steps = []
    initial = np.zeros(200)
    initial[0] = 1000.0
    got = radiosity.until_settled(factors, np.full(200, 0.999), initial, 1e-4, lambda: steps.append(1))
    np.testing.assert_allclose(got, exact(factors, np.full(200, 0.999), initial), rtol=2e-3)
    assert len(steps) < 40, "plain cycles would take thousands"
    assert area @ (0.001 * got) == pytest.approx(area @ initial, rel=1e-3), "all that comes in is absorbed"


def test_nothing_to_reflect():
    factors, _ = closed_factors(4)
    initial = np.array([1.0, 2.0, 3.0, 4.0])
    dark = radiosity.until_settled(factors, np.zeros(4), initial, 1e-4)
    np.testing.assert_array_equal(dark, initial)
    dark[0] = 99
    assert initial[0] == 1, "a copy"
    np.testing.assert_array_equal(radiosity.until_settled(factors, np.full(4, 0.5), np.zeros(4), 1e-4), 0)


@pytest.mark.parametrize("excess", [0.0, 1e-3])
def test_light_without_end_is_refused(excess):
    factors, _ = closed_factors(6)
    with pytest.raises(SceneError, match=r"multiplies without end: .* reflectance 1 .* lower the reflectances"):
        radiosity.until_settled(factors * (1 + excess), np.ones(6), np.ones(6), 1e-4)
    np.testing.assert_allclose(radiosity.by_cycles(factors, np.ones(6), np.ones(6), 5), 6.0)


@given(SYSTEMS)
def test_gain_is_an_upper_estimate(given_):
    factors, reflectance, _ = system(*given_)
    radius = float(np.abs(np.linalg.eigvals(factors * reflectance)).max())
    gain = radiosity.largest_gain(factors, reflectance)
    assert radius - 1e-9 <= gain <= float((factors @ reflectance).max()) + 1e-12


def test_checkpoints_can_stop():
    factors, _ = closed_factors(6)

    def stop():
        raise Cancelled("enough")

    for solver in (
        lambda: radiosity.by_cycles(factors, np.full(6, 0.5), np.ones(6), 3, stop),
        lambda: radiosity.until_settled(factors, np.full(6, 0.5), np.arange(6.0), 1e-6, stop),
    ):
        with pytest.raises(Cancelled):
            solver()


@pytest.fixture(scope="module")
def luminous_boxes():
    """Reflectance -> transfer of a closed box of that reflectance with exitance 100 everywhere."""
    return {
        r: prepare_coarse(box(luz.Material(diffuse_reflectance=r, exitance=100.0), (3, 2, 1.5)))
        for r in (0.0, 0.5, 0.9, 0.99, 0.999)
    }


@pytest.mark.parametrize("reflectance", [0.0, 0.5, 0.9, 0.99, 0.999])
def test_closed_box_in_closed_form(luminous_boxes, reflectance):
    """An even field is an exact solution: E = M / (1 - rho) (Sumpner 1892)."""
    result = luminous_boxes[reflectance].solve(DARK, tolerance=1e-6)
    np.testing.assert_allclose(result.illuminance, 100 / (1 - reflectance), rtol=1e-5 / (1 - reflectance))
    np.testing.assert_allclose(result.initial, 100, rtol=1e-6)
    np.testing.assert_allclose(result.exitance, 100 / (1 - reflectance), rtol=1e-5 / (1 - reflectance))


@pytest.mark.parametrize("cycles", [0, 1, 2, 5, 10])
def test_closed_box_by_cycles(luminous_boxes, cycles):
    result = luminous_boxes[0.9].solve(DARK, cycles=cycles)
    np.testing.assert_allclose(result.illuminance, 100 * sum(0.9**k for k in range(cycles + 1)), rtol=1e-5)
    np.testing.assert_allclose(result.initial, 100, rtol=1e-6)


def test_many_cycles_reach_the_limit(luminous_boxes):
    transfer = luminous_boxes[0.5]
    np.testing.assert_allclose(
        transfer.solve(DARK, cycles=40).illuminance, transfer.solve(DARK, tolerance=1e-8).illuminance, rtol=1e-7
    )


def test_a_white_closed_box_is_refused():
    transfer = prepare_coarse(box(luz.Material(diffuse_reflectance=1.0, exitance=1.0)))
    with pytest.raises(SceneError, match="closed scene of diffuse reflectance 1"):
        transfer.solve(DARK)
    np.testing.assert_allclose(transfer.solve(DARK, cycles=3).illuminance, 4, rtol=1e-5)


def test_a_white_box_with_an_opening_settles():
    """What enters by the opening leaves by it again: flux in equals flux out."""
    transfer = prepare_coarse(box(luz.Material(diffuse_reflectance=1.0), without=("ceiling",)))
    result = transfer.solve(UNIFORM, tolerance=1e-6)
    assert result.balance.escaped == pytest.approx(result.balance.entering, rel=2e-4)
    np.testing.assert_allclose(result.illuminance, np.pi * 1000, rtol=5e-3)  # in equilibrium with the sky


@settings(max_examples=10, deadline=None)
@given(st.lists(st.floats(0.0, 0.95), min_size=5, max_size=5), st.integers(0, 4))
def test_interreflection_is_the_series_of_the_transfer(reflectances, cycles):
    """Through the public API, E = F·ρE over patches, cycle by cycle."""
    names = ("floor", "south", "north", "west", "east")
    materials = {n: luz.Material(diffuse_reflectance=r) for n, r in zip(names, reflectances, strict=True)}
    transfer = prepare_coarse(box(without=("ceiling",), **materials), elements=60, patches=30, bands=12)
    result = transfer.solve(UNIFORM, cycles=cycles)
    if transfer.geometry.targets.patches.count == 0:
        assert not result.components["interreflected"].any()
        return
    cuts, patch = transfer.geometry.fracture, transfer.geometry.targets.patches.of_element
    initial = np.pi * 1000 * transfer.on_elements(transfer.sky_direct.dense()[:, :-1].sum(axis=1))
    area = np.bincount(patch[patch >= 0], weights=cuts.element_areas[patch >= 0])
    mean = np.bincount(patch[patch >= 0], weights=(cuts.element_areas * initial)[patch >= 0]) / area
    rho = np.zeros(len(area))
    surface_rho = np.array([m.diffuse_reflectance for m in transfer.geometry.surface_materials])
    rho[patch[patch >= 0]] = surface_rho[transfer.geometry.element_surface[patch >= 0]]
    expected = np.zeros(len(transfer.nodes.points))
    if cycles:
        exitance = rho * radiosity.by_cycles(transfer.exchange, rho, mean, cycles - 1)
        expected = transfer.form_factors @ exitance
        expected += transfer.conservation.spread * (transfer.conservation.missing @ exitance)
    np.testing.assert_allclose(
        result.components["interreflected"], cuts.side_means(transfer.on_elements(expected)), rtol=1e-5, atol=1e-4
    )
