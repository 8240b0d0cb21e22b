"""Profiles: light across narrow strips from the means of few patches."""

import numpy as np
import pytest

from luzespecular.profiles import Profile, profile_shares


def means(edges):
    """Means of 1 + 2 x + 3 x² between edges."""
    sums = edges + edges**2 + edges**3
    return np.diff(sums) / np.diff(edges)


@pytest.mark.parametrize("groups", [[0, 1, 2], [0, 1, 1, 2, 3], [0, 0, 1, 2, 2, 2, 3, 4]])
def test_a_parabola_is_told_by_the_means_of_three_and_more(groups):
    groups = np.array(groups)
    shares = profile_shares(groups, [(0, len(groups))], 5)
    borders = np.concatenate([[0], np.cumsum(np.bincount(groups))]).astype(float)
    np.testing.assert_allclose(shares @ means(borders), means(np.arange(5 * len(groups) + 1) / 5))


@pytest.mark.parametrize("groups", [[0], [0, 1], [0, 1, 1, 2], [0, 1, 2, 3, 4, 5]])
def test_means_of_patches_stay(groups):
    groups = np.array(groups)
    shares = profile_shares(groups, [(0, len(groups))], 3)
    np.testing.assert_allclose(shares.sum(axis=1), 1)
    of = np.repeat(groups, 3)
    back = np.array([shares[of == group].mean(axis=0) for group in range(groups.max() + 1)])
    np.testing.assert_allclose(back, np.eye(len(back)), atol=1e-12)


def test_nothing_is_told_across_the_end_of_a_stretch():
    shares = profile_shares(np.array([0, 1, 2, 3]), [(0, 2), (2, 2)], 3)
    assert not shares[:6, 2:].any() and not shares[6:, :2].any()


def test_folding_and_sharing_out():
    shares = profile_shares(np.array([0, 1, 2]), [(0, 3)], 3)
    profile = Profile(7, 1, 2, shares)
    columns = np.random.default_rng(1).uniform(0, 1, (4, 7 + 18))
    patches = columns[:, :7].copy()
    profile.fold(columns, patches)
    added = patches - columns[:, :7]
    assert not added[:, [0]].any()
    np.testing.assert_allclose(added[:, 1:4], columns[:, 7:16] @ shares)
    np.testing.assert_allclose(added[:, 4:], columns[:, 16:] @ shares)
    sent, landed = np.arange(1.0, 8.0), np.full(7, 2.0)
    profile.evened(sent, landed)
    np.testing.assert_allclose(landed, [2, *(np.arange(2, 8) * 12 / 27)])
