"""Results as tables: statistics per surface, rows of faces, and arrays."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .result import COMPONENTS, INITIAL, Result, Side


class Spread(NamedTuple):
    """Least, mean and largest illuminance of an area [lx], the mean weighted by area."""

    minimum: float
    mean: float
    maximum: float

    @property
    def uniformity(self) -> float:
        """Minimum over mean (EN 12665, U₀); NaN in the dark."""
        return self.minimum / self.mean if self.mean > 0.0 else float("nan")


@dataclass(frozen=True)
class SurfaceStatistics:
    """Illuminance of one side of a surface.

    Attributes
    ----------
    name : str
    side : "front" or "back"
    area : float
        [m²]
    spreads : dict of str to Spread
        By quantity, those of `QUANTITIES` first.
    """

    name: str
    side: str
    area: float
    spreads: dict[str, Spread]

    @property
    def total(self) -> Spread:
        """All light, interreflection included."""
        return self.spreads[QUANTITIES[0]]


def computed_faces(result: Result, names: Iterable[str]) -> Iterator[tuple[str, str, Side, NDArray[np.intp]]]:
    """Yield name, "front" or "back", that side's arrays and its faces for each side of the surfaces that has values."""
    for name in names:
        faces = result.faces_of(name)
        for label, side in (("front", result.front), ("back", result.back)):
            if side is not None:
                known = faces[~np.isnan(side.illuminance[faces])]
                if len(known):
                    yield name, label, side, known


def surface_statistics(
    result: Result, names: Iterable[str], more: dict[str, NDArray[np.float64]] | None = None
) -> list[SurfaceStatistics]:
    """Return the statistics of each side of the surfaces, in the order of `names`.

    Parameters
    ----------
    result : Result
    names : iterable of str
        Surfaces.
    more : dict of str to (n,) float, optional
        Further quantities of fronts, such as errors.
    """
    known = {"front": quantities(result.front) | (more or {})}
    if result.back is not None:
        known["back"] = quantities(result.back)
    stacked = {label: np.stack(list(values.values())) for label, values in known.items()}
    rows = []
    for name, label, side, faces in computed_faces(result, names):
        values, areas = stacked[label][:, faces], side.areas[faces]
        area = areas.sum()
        parts = (values.min(axis=1), (values * areas).sum(axis=1) / area, values.max(axis=1))
        spreads = map(Spread._make, np.column_stack(parts).tolist())
        rows.append(SurfaceStatistics(name, label, float(area), dict(zip(known[label], spreads, strict=True))))
    return rows


QUANTITIES = ("illuminance", "initial", *COMPONENTS)
"""What is told of faces and points: the total, what of it has met no diffuse surface, and the components."""


def quantities(side: Side) -> dict[str, NDArray[np.float64]]:
    """Return all illuminances of a side by name: total, initial and the components, (n,) [lx] each."""
    return {"illuminance": side.illuminance, "initial": side.initial, **side.components}


def point_quantities(result: Result, points, normals) -> dict[str, NDArray[np.float64]]:
    """Return the same of free points, (m,) [lx] each; see `Result.at`."""
    parts = result.at(points, normals, components=True)
    initial = np.sum([parts[name] for name in INITIAL], axis=0)
    return {"illuminance": initial + parts["interreflected"], "initial": initial, **parts}


SURFACE_HEADER = (
    *("surface", "side", "area_m2", "minimum_lx", "mean_lx", "maximum_lx", "uniformity"),
    *(f"{quantity}_{part}_lx" for quantity in QUANTITIES[1:] for part in Spread._fields),
)
"""Totals first, then the least, mean and largest of each other quantity."""


def surface_row(row: SurfaceStatistics) -> tuple[str | float, ...]:
    """Return a row for `SURFACE_HEADER`."""
    others = (value for quantity in QUANTITIES[1:] for value in row.spreads[quantity])
    return (row.name, row.side, row.area, *row.total, row.total.uniformity, *others)


def face_rows(result: Result, names: Iterable[str]) -> tuple[list[str], Iterator[list[str | float]]]:
    """Return header and rows of the solver's faces: surface, side, centroid [m], normal, area [m²], lux by origin."""
    header = ["surface", "side", "x_m", "y_m", "z_m", "normal_x", "normal_y", "normal_z", "area_m2"]
    header += [f"{quantity}_lx" for quantity in quantities(result.front)]

    def rows() -> Iterator[list[str | float]]:
        for name, label, side, faces in computed_faces(result, names):
            columns = [side.centroids[faces], side.normals[faces], side.areas[faces]]
            columns += [values[faces] for values in quantities(side).values()]
            for row in np.column_stack(columns).tolist():
                yield [name, label, *row]

    return header, rows()


def document(
    result: Result,
    statistics: Iterable[SurfaceStatistics],
    points: dict[str, dict[str, NDArray[np.float64]]],
    faces: Iterable[str] | None,
) -> dict[str, Any]:
    """Return what a JSON file says of a result.

    Parameters
    ----------
    result : Result
    statistics : iterable of SurfaceStatistics
    points : dict of str to dict
        `point_quantities` of sets of free points.
    faces : iterable of str or None
        Surfaces whose faces are listed; None: no list of faces.

    Returns
    -------
    dict
        Horizontal illuminances of sky and Sun [lx], surfaces, points, the lumen balance, and the faces.
    """
    balance = result.balance
    content: dict[str, Any] = {
        "sky_horizontal_illuminance_lx": result.light.sky_illuminance,
        "sun_horizontal_illuminance_lx": result.light.sun_illuminance,
        "surfaces": [dict(zip(SURFACE_HEADER, surface_row(row), strict=True)) for row in statistics],
        "points": {name: values["illuminance"].tolist() for name, values in points.items()},
        "point_quantities_lx": {
            name: {quantity: lux.tolist() for quantity, lux in values.items()} for name, values in points.items()
        },
        "balance_lm": {
            "entering": balance.entering,
            "absorbed": dict(balance.absorbed),
            "unlit": balance.unlit,
            "escaped": balance.escaped,
            "truncated": balance.truncated,
        },
        "balance_defect": balance.defect,
    }
    if faces is not None:
        header, rows = face_rows(result, faces)
        content["faces"] = {"columns": header, "rows": list(rows)}
    return content


def arrays(result: Result) -> dict[str, NDArray]:
    """Return all that is known of the faces: corners [m], surfaces, and the quantities of fronts and backs.

    ``surface`` holds indices into ``surfaces``, the names; names of backs' quantities begin with ``back_``, and are
    NaN where that side receives nothing.
    """
    surface = np.empty(len(result.areas), np.int64)
    for number, name in enumerate(result.surfaces):
        surface[result.faces_of(name)] = number
    known: dict[str, NDArray] = {
        "surfaces": np.array(result.surfaces),
        "surface": surface,
        "source_face": result.source_faces,
        "vertices": result.vertices,
        "centroids": result.centroids,
        "normals": result.normals,
        "areas": result.areas,
        "exitance": result.exitance,
        **quantities(result.front),
    }
    if result.back is not None:
        known["back_exitance"] = result.back.exitance
        known |= {f"back_{name}": values for name, values in quantities(result.back).items()}
    return known
