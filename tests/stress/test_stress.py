"""Situations that break numerics come out as expected: all but the long ones of ``python benchmarks/stress.py``."""

import pytest
import table
from situations import run

QUICK = [situation for situation in table.situations() if not situation.long]


def test_names_are_unique_and_families_full():
    names = [(situation.family, situation.name) for situation in table.situations()]
    assert len(set(names)) == len(names) > 180
    assert {family for family, _ in names} == {"invariance", "degenerate", "energy", "light", "scale", "precision"}


@pytest.mark.parametrize("situation", QUICK, ids=[f"{s.family}, {s.name}" for s in QUICK])
def test_as_expected(situation):
    outcome = run(situation)
    assert outcome.holds, (
        f"expected {outcome.expected}, got {outcome.got}: off by {outcome.error:g}, allowed {outcome.allowed:g}"
    )
