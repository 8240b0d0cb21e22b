"""Fixtures for all tests."""

import importlib.util
import sys
from pathlib import Path

import hypothesis
import pytest

ROOT = Path(__file__).resolve().parents[1]

hypothesis.settings.register_profile("project", deadline=None)  # how long a case takes says nothing of its truth
hypothesis.settings.load_profile("project")


@pytest.fixture(scope="session")
def light_shelf():
    """The paper's room as the bundled study builds it: ``light_shelf.scene("S1")``, ``light_shelf.daylight(12.0)``."""
    spec = importlib.util.spec_from_file_location("light_shelf_room", ROOT / "examples" / "light_shelf" / "room.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def by_globe(monkeypatch):
    """Closed convex rooms are looked at on the globe like all others, for tests of what that does."""
    from luzespecular.convex import ConvexRoom

    monkeypatch.setattr(ConvexRoom, "of", classmethod(lambda *_: None))
