"""Common building materials with their photometric values, and where the values come from.

Values are the middle of the range that the source gives. They are to begin with: what stands in a room is best
measured, or taken from its maker's data sheet. Metals count as mirrors where they are polished, as diffuse where matt.
"""

from __future__ import annotations

from typing import NamedTuple

SOURCES = {
    "AEDG": "ASHRAE/IES Advanced Energy Design Guide for K-12 school buildings: usual design values",
    "CS": "The Concrete Society: Reflectance of concrete (with CIBSE)",
    "DIAL": "DIAL GmbH, DIALux evo knowledge base: Photometric properties of materials",
    "ESPR": "ESP-r (Energy Systems Research Unit, Strathclyde): database of optical properties",
    "GP": "GharPedia: Reflection factor, table of commonly used materials",
    "OSRAM": "OSRAM, Encyclopedia of light: Reflection, table of colours and materials",
}
"""Full names of the sources."""

GLASS_INDEX = 1.52
"""Refractive index of window glass."""


class Entry(NamedTuple):
    """A material of the library.

    Attributes
    ----------
    key : str
        Never changes: scripts and files name it.
    name : str
        In English.
    group : str
        Heading of the menu.
    source : str
        Key of `SOURCES`.
    stated : str
        What the source states.
    diffuse, specular, transmittance : float
        Shares, 0 to 1; the transmittance is regular, of the whole pane at normal incidence.
    index : float or None
        Refractive index of a clear pane.
    """

    key: str
    name: str
    group: str
    source: str
    stated: str
    diffuse: float = 0.0
    specular: float = 0.0
    transmittance: float = 0.0
    index: float | None = None


LIBRARY = (
    Entry("CEILING", "Ceiling, usual", "Usual design values", "AEDG", "70 %", diffuse=0.70),
    Entry("WALL", "Wall, usual", "Usual design values", "AEDG", "50 %", diffuse=0.50),
    Entry("FLOOR", "Floor, usual", "Usual design values", "AEDG", "20 %", diffuse=0.20),
    Entry("PAINT_WHITE", "Paint, white", "Paint and plaster", "GP", "75–85 %", diffuse=0.80),
    Entry("PAINT_YELLOW", "Paint, light yellow", "Paint and plaster", "GP", "60–70 %", diffuse=0.65),
    Entry("PAINT_GREEN", "Paint, light green", "Paint and plaster", "GP", "45–55 %", diffuse=0.50),
    Entry("PAINT_GREY", "Paint, medium grey", "Paint and plaster", "GP", "25–35 %", diffuse=0.30),
    Entry("PAINT_BROWN", "Paint, brown", "Paint and plaster", "GP", "20–30 %", diffuse=0.25),
    Entry("PAINT_DARK", "Paint, dark blue, green or red", "Paint and plaster", "GP", "15–20 %", diffuse=0.175),
    Entry("GYPSUM", "Gypsum plaster", "Paint and plaster", "DIAL", "70–80 %", diffuse=0.75),
    Entry("RENDER_LIGHT", "Render, light", "Paint and plaster", "GP", "40–45 %", diffuse=0.425),
    Entry("RENDER_DARK", "Render, dark", "Paint and plaster", "GP", "15–25 %", diffuse=0.20),
    Entry("TILES_WHITE", "Tiles, white", "Stone, brick and concrete", "OSRAM", "0.7", diffuse=0.70),
    Entry("CONCRETE", "Concrete, untreated", "Stone, brick and concrete", "DIAL", "20–30 %", diffuse=0.25),
    Entry("CONCRETE_SMOOTH", "Concrete, smooth grey", "Stone, brick and concrete", "CS", "40 %", diffuse=0.40),
    Entry("CONCRETE_WHITE", "Concrete, white cement", "Stone, brick and concrete", "CS", "50 %", diffuse=0.50),
    Entry("BLOCK", "Breeze block", "Stone, brick and concrete", "OSRAM", "0.1", diffuse=0.10),
    Entry("BRICK_RED", "Brick, red, new", "Stone, brick and concrete", "DIAL", "10–15 %", diffuse=0.125),
    Entry("LIMESTONE", "Limestone", "Stone, brick and concrete", "GP", "35–55 %", diffuse=0.45),
    Entry("SANDSTONE", "Sandstone", "Stone, brick and concrete", "GP", "20–40 %", diffuse=0.30),
    Entry("GRANITE", "Granite", "Stone, brick and concrete", "GP", "20–25 %", diffuse=0.225),
    Entry("MARBLE", "Marble, polished", "Stone, brick and concrete", "GP", "30–70 %", diffuse=0.50),
    Entry("MAPLE", "Maple or birch", "Wood", "OSRAM", "0.6", diffuse=0.60),
    Entry("WOOD_LIGHT", "Wood, light", "Wood", "DIAL", "30–60 %", diffuse=0.45),
    Entry("OAK_LIGHT", "Oak, light, polished", "Wood", "GP", "25–35 %", diffuse=0.30),
    Entry("PLYWOOD", "Plywood, rough", "Wood", "GP", "25–40 %", diffuse=0.325),
    Entry("WALNUT", "Oak or walnut, dark", "Wood", "OSRAM", "0.2", diffuse=0.20),
    Entry("WOOD_DARK", "Wood, dark", "Wood", "DIAL", "10–15 %", diffuse=0.125),
    Entry("MIRROR", "Mirror, silvered glass", "Mirrors and metals", "GP", "80–88 %", specular=0.84),
    Entry("ALUMINIUM_PURE", "Aluminium, pure, highly polished", "Mirrors and metals", "GP", "80–87 %", specular=0.835),
    Entry("ALUMINIUM", "Aluminium, polished", "Mirrors and metals", "GP", "65–75 %", specular=0.70),
    Entry("CHROME", "Chrome, polished", "Mirrors and metals", "GP", "60–70 %", specular=0.65),
    Entry("ALUMINIUM_ANODISED", "Aluminium, anodised, matt", "Mirrors and metals", "GP", "80–85 %", diffuse=0.825),
    Entry("ALUMINIUM_MATT", "Aluminium, matt", "Mirrors and metals", "GP", "55–75 %", diffuse=0.65),
    Entry("ENAMEL", "Enamel, white", "Mirrors and metals", "GP", "65–75 %", diffuse=0.70),
    Entry("GLASS_4", "Glass, clear, 4 mm", "Glass", "ESPR", "0.89", transmittance=0.89, index=GLASS_INDEX),
    Entry(
        "GLASS_DOUBLE", "Double glazing, clear, 4 mm", "Glass", "ESPR", "0.80", transmittance=0.80, index=GLASS_INDEX
    ),
    Entry(
        "GLASS_DOUBLE_6", "Double glazing, clear, 6 mm", "Glass", "ESPR", "0.76", transmittance=0.76, index=GLASS_INDEX
    ),
)
"""All entries, group by group."""


def groups() -> dict[str, list[Entry]]:
    """Return the entries by group, in their order."""
    found: dict[str, list[Entry]] = {}
    for entry in LIBRARY:
        found.setdefault(entry.group, []).append(entry)
    return found


def entry_of(key: str) -> Entry | None:
    """Return the entry of a key; None where there is none such (any more)."""
    return next((entry for entry in LIBRARY if entry.key == key), None)
