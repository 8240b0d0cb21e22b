"""All situations, family by family."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import by_paths
import degenerate
import drawing
import energy
import equilibrium
import extent
import glass
import invariance
import kept
import known_answers
import lights
import meshes
import openings
import precision
import shapes
import sides
import year
from situations import Situation

ROOMS = (
    *(known_answers, invariance, degenerate, drawing, energy, lights, extent, precision),
    *(equilibrium, glass, kept, meshes, openings, shapes, sides, year, by_paths),
)
ALIKE = (
    *("E01-scale1", "E01-scale2", "E02-translate0", "E02-translate1", "E02-translate2", "E03-rotz1", "E03-rotz2"),
    *("E03-rotz3", "E04-rot1", "E06", "E07", "E10", "E12", "E32-rho0.9999", "room 0.1 m", "room 100 m", "1000 m off"),
    *(
        "10000 m off",
        "100000 m off",
        "by 45°",
        "by 90°",
        "by 123",
        "by 271",
        "other corners",
        "of quads",
        "of triangles",
    ),
    *("aspect 1e8", "plane, outside", "three planes", "by others", "at 0.01°", "length 5", "length 4.5", "length 20"),
    *("400 surfaces", "under 800", "3 threads", "8 threads", "50000 cells", "2000000 cells", "lights in between"),
)
"""Parts of names of situations that take seconds and are much like others: run with the long ones."""


def situations() -> Iterator[Situation]:
    for room in ROOMS:
        for situation in room.situations():
            yield replace(situation, long=situation.long or any(part in situation.name for part in ALIKE))
