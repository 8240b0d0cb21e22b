"""Skips: what a scene does not need, and why it is left out."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .geometry import Geometry


def needless(geometry: Geometry, sees_out: bool, unhidden: bool) -> Iterator[tuple[str, str]]:
    """Name of each step that was left out, and the reason.

    Parameters
    ----------
    geometry : Geometry
    sees_out : bool
        Whether any receiver sees the sky or the ground.
    unhidden : bool
        Whether nothing stands in the way of anything.
    """
    outlines, materials = geometry.outlines, geometry.surface_materials
    if not outlines.any_specular:
        yield "specular chains", "no surface mirrors or transmits regularly"
    if not sees_out:
        yield "form factors to the sky", "the scene is closed: nothing sees the sky or the ground"
    if unhidden:
        yield "occlusion", "the scene is closed, convex and empty: nothing stands in the way"
    black = [m.diffuse_reflectance == 0 and m.exitance == 0 for m in materials]
    if any(black):
        yield "patches of black surfaces", f"{sum(black)} of {len(black)} surfaces send out no diffuse light"
    blind = np.count_nonzero(~outlines.back_counts)
    if blind:
        yield "backs", f"{blind} of {len(outlines.vertices)} outlines have a back that receives nothing"
    if outlines.facets is None:
        apart, pairs = _hidden_pairs(geometry)
        if apart:
            yield "pairs that cannot see each other", f"{apart} of {pairs} outlines lie behind the receivers' plane"
    if not geometry.wanted.all():
        unwanted = np.count_nonzero(~geometry.wanted)
        yield "faces", f"{unwanted} of {len(geometry.wanted)} surfaces are no receivers: cut for interreflection alone"


def _hidden_pairs(geometry: Geometry) -> tuple[int, int]:
    """Outlines that lie wholly behind a receivers' plane, summed over these planes, and all pairs of the two."""
    outlines, planes, fronts = geometry.outlines, geometry.planes, len(geometry.planes.sheet_surface)
    hidden, sheets = 0, np.unique(geometry.lit_side)
    for sheet in sheets:
        own = int(np.flatnonzero(planes.outline_sheet == sheet % fronts)[0])
        side = -1.0 if sheet >= fronts else 1.0
        height = side * (outlines.vertices @ outlines.normals[own] - outlines.offsets[own])
        hidden += int(np.count_nonzero((height <= outlines.tolerance).all(axis=1)))
    return hidden, len(sheets) * len(outlines.vertices)
