"""The benchmark's scenes: what ``data/*.json`` hold, and the same scene in the words of the solver.

A file holds one scene: its ``origin``; its surfaces as parallelograms ``(q, 4, 3)`` [m] with their materials; the size
of face to take [m²]; and what is known of it, as *measures*: a light, places with normals, the lux that arrives there,
and the standard error where the lux come from Monte Carlo.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import luzespecular as luz

DATA = Path(__file__).parent / "data"
NAMES = (
    "seed_room",
    "seed_room_diffuse",
    "roof_opening",
    "louvres",
    "light_pipe",
    "sun_patch",
    "white_box",
    "luminous_ceiling",
    "furnished",
)
OTHERS = ("seed_room_noon",)
"""Scenes of other benchmarks than `time_and_error`."""

BELOW = 0.01
"""Places below this share of a measure's largest value are compared with that share, not with themselves."""


@dataclass(frozen=True)
class Surface:
    """Parallelograms of one material; ``two_sided`` where the backs reflect as well.

    Attributes
    ----------
    quads : (q, 4, 3) float [m], their front by the right-hand rule
    diffuse_reflectance, specular_reflectance : float
    exitance : float [lm/m²]
    two_sided : bool
    """

    quads: np.ndarray
    diffuse_reflectance: float = 0.0
    specular_reflectance: float = 0.0
    exitance: float = 0.0
    two_sided: bool = False


@dataclass(frozen=True)
class Measure:
    """Known illuminances under one light.

    Attributes
    ----------
    label : str
    light : luzespecular.Daylight
    initial : bool
        Whether ``lux`` are those before any diffuse reflection.
    points, normals : (m, 3) float
    lux, standard_error : (m,) float [lx]; an error of 0 where the values are exact
    """

    label: str
    light: luz.Daylight
    initial: bool
    points: np.ndarray
    normals: np.ndarray
    lux: np.ndarray
    standard_error: np.ndarray

    @property
    def scale(self) -> np.ndarray:
        """(m,) float: what errors are relative to [lx]."""
        return np.maximum(self.lux, BELOW * self.lux.max())

    @property
    def noise(self) -> float:
        """RMS of the reference's own relative standard error."""
        return float(np.sqrt(np.mean((self.standard_error / self.scale) ** 2)))

    def errors(self, lux) -> np.ndarray:
        """(m,) float: relative errors of illuminances ``(m,)``."""
        return (np.asarray(lux, float) - self.lux) / self.scale


@dataclass(frozen=True)
class BenchmarkScene:
    """A scene with known answers.

    Attributes
    ----------
    name, title, origin : str
    surfaces : dict of str to Surface
    max_area : float
        Largest face [m²], for both methods.
    measures : tuple of Measure
    """

    name: str
    title: str
    origin: str
    surfaces: dict[str, Surface]
    max_area: float
    measures: tuple[Measure, ...]

    @property
    def quads(self) -> int:
        """How many parallelograms the scene has."""
        return sum(len(surface.quads) for surface in self.surfaces.values())

    def solver_scene(self) -> luz.Scene:
        """Return the scene as the solver takes it."""
        scene = luz.Scene()
        for name, surface in self.surfaces.items():
            material = luz.Material(
                diffuse_reflectance=surface.diffuse_reflectance,
                specular_reflectance=surface.specular_reflectance,
                exitance=surface.exitance,
            )
            if len(surface.quads) == 1:
                scene.add(name, surface.quads[0], material, two_sided=surface.two_sided)
            else:
                faces = np.arange(4 * len(surface.quads)).reshape(-1, 4)
                vertices = surface.quads.reshape(-1, 3)
                scene.add(name, vertices, material, faces=faces, two_sided=surface.two_sided)
        return scene


def daylight(facts: dict) -> luz.Daylight:
    """Light from its facts: a ``sky`` of a ``type`` with ``options``, a ``sun``, both or none."""
    sky = luz.CIESky(facts["sky"]["type"], **facts["sky"]["options"]) if "sky" in facts else None
    return luz.Daylight(sky=sky, sun=luz.Sun(**facts["sun"]) if "sun" in facts else None)


def load(name: str) -> BenchmarkScene:
    """Read a scene by its name.

    Parameters
    ----------
    name : str
        A file of ``data/`` without its ending: one of `NAMES`.

    Returns
    -------
    BenchmarkScene
    """
    facts = json.loads((DATA / f"{name}.json").read_text(encoding="utf-8"))
    surfaces = {
        key: Surface(**{**surface, "quads": np.array(surface["quads"], float)})
        for key, surface in facts["surfaces"].items()
    }
    measures = []
    for measure in facts["measures"]:
        lux = np.array(measure["lux"], float)
        error = np.array(measure.get("standard_error", np.zeros(len(lux))), float)
        points, normals = np.array(measure["points"], float), np.array(measure["normals"], float)
        measures.append(
            Measure(measure["label"], daylight(measure["light"]), measure["initial"], points, normals, lux, error)
        )
    return BenchmarkScene(name, facts["title"], facts["origin"], surfaces, facts["max_area"], tuple(measures))


def write(name: str, title: str, origin: str, surfaces: dict, max_area: float, measures: list[dict]) -> None:
    """Write a scene's file, one array a line.

    Parameters
    ----------
    name, title, origin : str
    surfaces : dict of str to dict
        Keywords of `Surface`, the quads as lists.
    max_area : float
    measures : list of dict
        ``label``, ``light`` (facts), ``initial``, ``points``, ``normals``, ``lux`` and perhaps ``standard_error``.
    """

    def text(value, depth: int = 0) -> str:
        if isinstance(value, dict) and depth < 4:
            rows = [f"{' ' * (depth + 1)}{json.dumps(key)}: {text(item, depth + 1)}" for key, item in value.items()]
            return "{\n" + ",\n".join(rows) + "\n" + " " * depth + "}"
        if isinstance(value, list) and value and isinstance(value[0], dict):
            return "[" + ", ".join(text(item, depth + 1) for item in value) + "]"
        return json.dumps(value, ensure_ascii=False, separators=(",", ":"))

    facts = {"title": title, "origin": origin, "max_area": max_area, "surfaces": surfaces, "measures": measures}
    (DATA / f"{name}.json").write_text(text(facts) + "\n", encoding="utf-8")
