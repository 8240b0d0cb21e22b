"""Radiance on a scene of the benchmark: same surfaces, sky and Sun, lux at points by `rtrace` (the pyradiance wheel).

Grey all through: what Radiance calls radiance is luminance here, and irradiance illuminance. Backs are black, as in the
solver: behind every surface stands a black one.
"""

from __future__ import annotations

import importlib.util
import tempfile
from pathlib import Path

import numpy as np
import scenes

import luzespecular as luz

BLACK_BEHIND = 1e-4
"""How far behind surfaces their black backs stand [m]."""

SUN_ANGLE = 0.05
"""The reference's Sun is a point; Radiance's needs a size [degrees]."""

CLEAR = {"kind": 12, "a": -1.0, "b": -0.32, "c": 10.0, "d": -3.0, "e": 0.45}
"""ISO 15469:2004, table 1."""

COMMON = ("-av", "0", "0", "0", "-dc", "1", "-dt", "0", "-lr", "-12", "-lw", "1e-4")

SETTINGS = (
    {"cache": False, "ab": 2, "ad": 16, "as": 0},
    {"cache": False, "ab": 3, "ad": 64, "as": 32},
    {"cache": True, "ab": 5, "ad": 512, "as": 128, "aa": 0.2, "ar": 64},
    {"cache": False, "ab": 5, "ad": 256, "as": 128},
    {"cache": True, "ab": 6, "ad": 1024, "as": 256, "aa": 0.15, "ar": 128},
    {"cache": False, "ab": 6, "ad": 512, "as": 256},
    {"cache": True, "ab": 7, "ad": 2048, "as": 512, "aa": 0.1, "ar": 256},
)
"""Roughly from the quickest to the slowest."""

QUICK = (
    {"cache": False, "ab": 1, "ad": 8, "as": 0},
    {"cache": True, "ab": 1, "ad": 16, "as": 0, "aa": 0.5, "ar": 8},
)
"""Only to see that it runs."""


def available() -> bool:
    """Whether Radiance is installed."""
    return importlib.util.find_spec("pyradiance") is not None


def label(setting: dict) -> str:
    """A setting in Radiance's own words."""
    words = [f"-ab {setting['ab']} -ad {setting['ad']} -as {setting['as']}"]
    words.append(f"-aa {setting['aa']:g} -ar {setting['ar']}" if setting["cache"] else "-aa 0")
    return " ".join(words)


def cost(setting: dict) -> float:
    """About in proportion to the seconds that a setting takes, among those with or without a cache."""
    rays = (setting["ad"] + setting["as"]) * (1.5 if setting["cache"] else setting["ab"])
    return rays / setting["aa"] ** 2 if setting["cache"] else rays


def description(scene: scenes.BenchmarkScene, light: luz.Daylight, calculation: str) -> str:
    """The scene and its light in Radiance's language; the sky, of type 12 or none, by a .cal file."""
    lines = ["void plastic black 0 0 5 0 0 0 0 0"]
    for name, surface in scene.surfaces.items():
        if surface.two_sided or surface.exitance:
            raise ValueError(f"'{name}': surfaces of two sides and luminous ones are not described here")
        rho = surface.specular_reflectance
        kind = f"mirror {name} 0 0 3 {rho} {rho} {rho}" if rho else None
        rho = surface.diffuse_reflectance
        lines.append("void " + (kind or f"plastic {name} 0 0 5 {rho} {rho} {rho} 0 0"))
        for k, quad in enumerate(surface.quads):
            normal = np.cross(quad[1] - quad[0], quad[3] - quad[0])
            back = (quad - BLACK_BEHIND * normal / np.linalg.norm(normal))[::-1]
            for what, corners in ((name, quad), ("black", back)):
                numbers = " ".join(f"{x:.9g}" for x in corners.ravel())
                lines.append(f"{what} polygon {name}.{k}.{what} 0 0 12 {numbers}")
    if light.sun is not None:
        luminance = light.sun.normal_illuminance / (2 * np.pi * (1 - np.cos(np.radians(SUN_ANGLE / 2))))
        towards = " ".join(f"{x:.9g}" for x in light.sun.direction)
        lines.append(f"void light solar 0 0 3 {luminance:.9g} {luminance:.9g} {luminance:.9g}")
        lines.append(f"solar source sun 0 0 4 {towards} {SUN_ANGLE}")
    if light.sky is not None:
        if light.sun is None or getattr(light.sky, "kind", None) != CLEAR["kind"]:
            raise ValueError(f"only skies of type {CLEAR['kind']} with their Sun are described here")
        lines += [
            f"void brightfunc sky_luminance 2 luminance {calculation} 0 0",
            "sky_luminance glow sky_glow 0 0 4 1 1 1 0",
            "sky_glow source sky 0 0 4 0 0 1 180",
        ]
    return "\n".join(lines) + "\n"


def sky_function(light: luz.Daylight) -> str:
    """The sky's luminance as Radiance's .cal file [cd/m²]."""
    x, y, z = (float(c) for c in light.sun.direction)
    a, b, c, d, e = (CLEAR[k] for k in "abcde")
    scale = f"{light.sky.zenith_luminance:.12g} / (phi(1) * f({np.arccos(z):.12g}))"
    return (
        f"phi(s) : 1 + ({a}) * exp(({b}) / s);\n"
        f"f(t) : 1 + {c} * (exp(({d}) * t) - exp(({d}) * PI / 2)) + {e} * cos(t) * cos(t);\n"
        f"cosine = Dx * ({x:.12g}) + Dy * ({y:.12g}) + Dz * ({z:.12g});\n"
        "away = acos(if(cosine - 1, 1, cosine));\n"
        f"luminance = if(Dz - 1e-6, {scale} * phi(Dz) * f(away), 0);\n"
    )


def trace(scene: scenes.BenchmarkScene, light: luz.Daylight, points, normals, setting: dict, threads: int):
    """Illuminance at points.

    Parameters
    ----------
    scene : BenchmarkScene
    light : luzespecular.Daylight
        A sky of CIE type 12 with its Sun, a Sun alone.
    points, normals : (m, 3) float
    setting : dict
        One of `SETTINGS`.
    threads : int

    Returns
    -------
    (m,) float [lx]
    """
    import pyradiance

    options = [*COMMON, *(str(word) for key in ("ab", "ad", "as") for word in (f"-{key}", setting[key]))]
    with tempfile.TemporaryDirectory() as folder:
        room, calculation, octree = (Path(folder) / name for name in ("room.rad", "sky.cal", "room.oct"))
        room.write_text(description(scene, light, str(calculation)), encoding="utf-8")
        if light.sky is not None:
            calculation.write_text(sky_function(light), encoding="ascii")
        octree.write_bytes(pyradiance.oconv(room))
        if setting["cache"]:
            options += ["-aa", str(setting["aa"]), "-ar", str(setting["ar"]), "-af", str(Path(folder) / "cache.amb")]
        else:
            options += ["-aa", "0"]
        rays = np.concatenate([points, normals], axis=1).astype("<f4").tobytes()
        found = pyradiance.rtrace(
            rays,
            octree,
            header=False,
            inform="f",
            outform="f",
            irradiance=True,
            outspec="v",
            nproc=threads,
            params=options,
        )
    return np.frombuffer(found, "<f4").reshape(-1, 3).mean(axis=1).astype(float)
