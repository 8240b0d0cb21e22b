"""Fineness: bands for an error, and for the receivers of faces."""

import pytest

from luzespecular.fineness import receiver_bands


@pytest.mark.parametrize(("bands", "of_receivers"), [(2, 2), (12, 12), (24, 24), (30, 24), (60, 24), (100, 40)])
def test_receivers_look_by_fewer_bands_where_these_are_enough(bands, of_receivers):
    assert receiver_bands(bands) == of_receivers
