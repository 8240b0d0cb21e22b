"""Results as tables: statistics per surface, and CSV files that spreadsheets open. No bpy."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .. import core as luz
from ..core.result import Side


@dataclass(frozen=True)
class SurfaceStatistics:
    """Illuminance of one side of a surface.

    Attributes
    ----------
    name : str
    side : "front" or "back"
    area : float
        [m²]
    minimum, mean, maximum : float
        [lx], the mean weighted by area.
    """

    name: str
    side: str
    area: float
    minimum: float
    mean: float
    maximum: float

    @property
    def uniformity(self) -> float:
        """Minimum over mean (EN 12665, U₀); NaN in the dark."""
        return self.minimum / self.mean if self.mean > 0.0 else float("nan")


def computed_faces(result: luz.Result, names: Iterable[str]) -> Iterator[tuple[str, str, Side, NDArray[np.intp]]]:
    """Yield name, "front" or "back", that side's arrays and its faces for each side of the surfaces that has values."""
    for name in names:
        faces = result.faces_of(name)
        for label, side in (("front", result.front), ("back", result.back)):
            if side is not None:
                known = faces[~np.isnan(side.illuminance[faces])]
                if len(known):
                    yield name, label, side, known


def surface_statistics(result: luz.Result, names: Iterable[str]) -> list[SurfaceStatistics]:
    """Return the statistics of each side of the surfaces, in the order of `names`."""
    rows = []
    for name, label, side, faces in computed_faces(result, names):
        values, areas = side.illuminance[faces], side.areas[faces]
        mean = float(np.average(values, weights=areas))
        rows.append(SurfaceStatistics(name, label, float(areas.sum()), float(values.min()), mean, float(values.max())))
    return rows


def quantities(side: Side) -> dict[str, NDArray[np.float64]]:
    """Return all illuminances of a side by name: total, initial and the components, (n,) [lx] each."""
    return {"illuminance": side.illuminance, "initial": side.initial, **side.components}


SURFACE_HEADER = ("surface", "side", "area_m2", "minimum_lx", "mean_lx", "maximum_lx", "uniformity")


def surface_row(row: SurfaceStatistics) -> tuple[str, ...]:
    """Return a row for `SURFACE_HEADER`."""
    numbers = (row.area, row.minimum, row.mean, row.maximum, row.uniformity)
    return (row.name, row.side, *(_number(value) for value in numbers))


def face_rows(result: luz.Result, names: Iterable[str]) -> tuple[list[str], Iterator[list[str]]]:
    """Return header and rows of the solver's faces: surface, side, centroid [m], normal, area [m²], lux by origin."""
    header = ["surface", "side", "x_m", "y_m", "z_m", "normal_x", "normal_y", "normal_z", "area_m2"]
    header += [f"{quantity}_lx" for quantity in quantities(result.front)]

    def rows() -> Iterator[list[str]]:
        for name, label, side, faces in computed_faces(result, names):
            columns = [side.centroids[faces], side.normals[faces], side.areas[faces]]
            columns += [values[faces] for values in quantities(side).values()]
            for row in np.column_stack(columns):
                yield [name, label, *map(_number, row)]

    return header, rows()


def write_csv(path: Path, header: Sequence[str], rows: Iterable[Sequence[str]]) -> Path:
    """Write a CSV file (UTF-8 with signature, so that spreadsheets read accents) that appears only when complete."""
    unfinished = path.with_name(path.name + ".part")
    try:
        with unfinished.open("w", encoding="utf-8-sig", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(header)
            writer.writerows(rows)
        unfinished.replace(path)
    finally:
        unfinished.unlink(missing_ok=True)
    return path


def _number(value: float) -> str:
    return "" if np.isnan(value) else f"{value:.7g}"
