"""The table of surfaces: statistics of every quantity, kept with the scene as long as its results."""

from __future__ import annotations

import math

import bpy

from .. import core as luz
from ..core import tables
from . import errors
from .choices import QUANTITY_ITEMS
from .export import Export

_QUANTITIES = [quantity for quantity, _, _ in QUANTITY_ITEMS]

_UNKNOWN = tables.Spread(math.nan, math.nan, math.nan)


def fill(scene: bpy.types.Scene, export: Export, result: luz.Result) -> None:
    """Write a row for each side of the surfaces, in place of those before."""
    rows = scene.luzespecular.results.rows
    rows.clear()
    receivers = {surface.name: surface for surface in export.surfaces if surface.receiver}
    error = errors.known(result)
    more = None if error is None else {"error": error}
    for found in tables.surface_statistics(result, receivers, more):
        row = rows.add()
        row.name, row.object_name = found.name, receivers[found.name].object_name
        row.side, row.area = found.side, found.area
        row.minima, row.means, row.maxima = zip(
            *(found.spreads.get(quantity, _UNKNOWN) for quantity in _QUANTITIES), strict=True
        )


def spread(row: bpy.types.PropertyGroup, quantity: str) -> tables.Spread:
    """Return the statistics of a quantity in a row [lx]; NaN where it was not computed."""
    place = _QUANTITIES.index(quantity)
    return tables.Spread(row.minima[place], row.means[place], row.maxima[place])


def statistics(row: bpy.types.PropertyGroup) -> tables.SurfaceStatistics:
    """Return a row as the solver's tables have it."""
    spreads = {quantity: spread(row, quantity) for quantity in _QUANTITIES}
    return tables.SurfaceStatistics(row.name, row.side, row.area, spreads)
