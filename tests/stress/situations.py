"""Situations that break numerics, each with the answer or the refusal that is expected; see `test_stress`.

A situation's outcome is compared with what is stated there, never with an earlier run. The same table is printed by
``python benchmarks/stress.py``.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from builders import prepare_coarse

import luzespecular as luz

BALANCE = 1e-3
"""Relative defect of the lumen balance that is allowed in any scene."""

FEWEST_BANDS = 24
"""On coarser globes, which serve where light is exact without any, what escapes is not known well enough to balance."""

GLOBE = 0.01
"""What the globe of 60 bands may be off at a point, relative to the point's value (docs/validation.md)."""

SINGLE = 1e-5
"""Float32 in the bulk of the work: relative to all light, per value."""


@dataclass(frozen=True)
class Outcome:
    """What came of a situation: in order where ``error`` is at most ``allowed``."""

    expected: str
    got: str
    error: float
    allowed: float

    @property
    def holds(self) -> bool:
        return bool(self.error <= self.allowed)  # never for NaN


@dataclass(frozen=True)
class Situation:
    """``run`` gives the outcome; ``long`` ones are left out of the tests."""

    family: str
    name: str
    run: Callable[[], Outcome]
    long: bool = False


def near(got, expected, relative: float, absolute: float = 0.0) -> Outcome:
    """Values within ``relative`` of the expected, or within ``absolute`` lux."""
    got, expected = (values.ravel() for values in np.broadcast_arrays(np.atleast_1d(got), np.asarray(expected, float)))
    allowed = np.maximum(relative * np.abs(expected), absolute)
    excess = np.abs(got - expected) / np.where(allowed > 0, allowed, 1e-300)
    worst = int(np.argmax(np.where(np.isnan(excess), np.inf, excess)))
    error = float(np.abs(got - expected)[worst])
    return Outcome(f"{expected[worst]:.9g}", f"{got[worst]:.9g}", error, float(allowed[worst]))


def holds(true: bool, expected: str, got: str) -> Outcome:
    return Outcome(expected, got, 0.0 if true else math.inf, 0.0)


def refused(act: Callable[[], object], *words: str) -> Outcome:
    """A `SceneError` whose message has these words."""
    try:
        act()
    except luz.SceneError as error:
        said = str(error)
        return holds(all(word in said for word in words), f"refused, naming {', '.join(words) or 'it'}", said[:60])
    return holds(False, "refused", "accepted")


def told(scene: luz.Scene, *kinds: str) -> Outcome:
    """Findings of the scene check that include one of these kinds."""
    found = {finding.kind for finding in luz.check(scene)}
    return holds(bool(found & set(kinds)), f"told: {' or '.join(kinds)}", ", ".join(sorted(found)) or "nothing told")


def all_of(*outcomes: Outcome) -> Outcome:
    """The worst of several outcomes."""
    return min(outcomes, key=lambda outcome: (outcome.holds, -outcome.error / max(outcome.allowed, 1e-300)))


def solved(scene: luz.Scene, light: luz.Daylight, *, elements=80, patches=60, bands=60, tolerance=1e-6, **options):
    """Result of a coarse run, after a look at what must hold in every scene."""
    result = prepare_coarse(scene, elements=elements, patches=patches, bands=bands, **options).solve(
        light, tolerance=tolerance
    )
    assert_sound(result, bands >= FEWEST_BANDS)
    return result


def assert_sound(result: luz.Result, balanced: bool = True) -> None:
    """No NaN, nothing negative, and a balance that closes."""
    sides = [result.front] if result.back is None else [result.front, result.back]
    for side in sides:
        known = side.illuminance[~np.isnan(side.illuminance)] if side is not result.front else side.illuminance
        if not np.isfinite(known).all() or (known < 0).any():
            raise AssertionError(f"illuminance from {known.min()} to {known.max()}")
    if balanced and not abs(result.balance.defect) <= BALANCE:
        raise AssertionError(f"the lumen balance is open by {result.balance.defect:.2%}")


def run(situation: Situation) -> Outcome:
    """The outcome; a failure of any sort is one that does not hold."""
    try:
        return situation.run()
    except (luz.LuzEspecularError, AssertionError, ArithmeticError, ValueError, IndexError, MemoryError) as error:
        return holds(False, "an answer", f"{type(error).__name__}: {str(error)[:70]}")
