"""Store: transfers saved to files and loaded again.

A file is NumPy's .npz of plain arrays. Its first, ``header``, is JSON: format, fingerprint, sizes. Geometry is not in
it: that follows from the scene in a moment, and what the file holds is used only where it fits.
"""

from __future__ import annotations

import json
import struct
import zipfile
import zlib
from dataclasses import asdict, fields
from pathlib import Path
from tokenize import TokenError
from typing import Any

import numpy as np

from .enclosures import Enclosures
from .errors import TransferFileError
from .fingerprint import Fingerprint
from .form_factors import Conservation, Exchange
from .geometry import Geometry, make_geometry
from .globe import Globe
from .inspection import inspect
from .nodes import Nodes
from .options import Options
from .planes import find_planes
from .scene import Scene
from .sparse import SparseRows
from .stages import Stage
from .tracing import ChainLimits, exact_mirrors
from .transfer import Transfer
from .weights import Weights
from .writing import complete

_DAMAGED = (
    *(zipfile.BadZipFile, zlib.error, struct.error, EOFError, ValueError, KeyError, TypeError, OverflowError),
    *(SyntaxError, TokenError, RuntimeError, MemoryError),
)
"""What NumPy and zipfile raise over bytes that they cannot make sense of, and `_array` over what does not fit."""

FORMAT = 6
"""Raised with every change of what files hold or of how it is found."""

_ARRAYS = (
    "form_factors",
    "deep_factors",
    "deep_rows",
    "unlit",
    "truncated",
    "unsure",
)
_SKY = ("sky_direct", "sky_specular")
_WEIGHTS = ("weights", "around")
_PARTS = ("of_patches", "of_nodes", "of_elements")


def save_transfer(transfer: Transfer, path) -> Path:
    """See `Transfer.save`."""
    path = Path(path)
    header = {
        "format": FORMAT,
        "fingerprint": asdict(transfer.fingerprint),
        "bands": transfer.geometry.targets.globe.bands,
        "beams": transfer.geometry.beams.bands,
        "times": transfer.times,
        "unhidden": transfer.unhidden,
        "sizes": _sizes(transfer.geometry),
        "stages": [asdict(stage) for stage in transfer.stages],
    }
    arrays = {name: getattr(transfer, name) for name in _ARRAYS}
    for name in _SKY:
        arrays |= {f"{name}_{part}": values for part, values in getattr(transfer, name).packed().items()}
    arrays["lattice_nodes"] = np.array(len(transfer.lattice.points))
    for name in ("points", "element"):
        arrays[f"nodes_{name}"] = getattr(transfer.nodes, name)
    for name in _WEIGHTS:
        for part in fields(Weights):
            arrays[f"{name}_{part.name}"] = getattr(getattr(transfer.nodes, name), part.name)
    arrays["exchange_factors"] = transfer.exchange.factors
    arrays["exchange_spread"] = transfer.exchange.spread
    for name in ("lost", "spread", "missing", "beyond"):
        arrays[f"conservation_{name}"] = getattr(transfer.conservation, name)
    for name in _PARTS:
        arrays[f"enclosures_{name}"] = getattr(transfer.conservation.enclosures, name)
    text = json.dumps(header).encode()
    with complete(path) as unfinished, unfinished.open("wb") as file:
        np.savez(file, header=np.frombuffer(text, np.uint8), **arrays)
    return path


def load_transfer(path, scene: Scene, options: Options | None, threads: int) -> Transfer:
    """Read a transfer for a scene.

    Parameters
    ----------
    path : path
    scene : Scene
    options : Options or None
        Those that it must have been prepared with; None = whatever they were.
    threads : int

    Returns
    -------
    Transfer

    Raises
    ------
    TransferFileError
        Where the file is stale, damaged, or no transfer.
    OSError
        Where it cannot be read.
    """
    path = Path(path)
    remedy = "delete it, prepare the scene and save anew"
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as content:
            if not isinstance(content, np.lib.npyio.NpzFile) or "header" not in content.files:
                raise TransferFileError(f"'{path}' is no saved transfer; name another file")
            header = _header(content["header"])
            if header["format"] != FORMAT:
                raise TransferFileError(f"'{path}' was saved by another version of the program; {remedy}")
            kept = _options(header["fingerprint"]["options"])
            known = Fingerprint(asdict(kept), tuple(map(tuple, header["fingerprint"]["surfaces"])))
            difference = known.difference(Fingerprint.of(scene, options or kept))
            if difference:
                raise TransferFileError(f"'{path}' is stale: it was saved for {difference}; {remedy}")
            return _rebuilt(scene, kept, known, header, content, threads)
    except TransferFileError:
        raise
    except _DAMAGED as error:
        raise TransferFileError(f"'{path}' is damaged or no saved transfer ({error}); {remedy}") from error


def _header(content: np.ndarray) -> dict[str, Any]:
    header = json.loads(content.astype(np.uint8).tobytes())
    if not isinstance(header, dict) or not isinstance(header.get("format"), int):
        raise ValueError("no header")
    return header


def _options(given: dict[str, Any]) -> Options:
    names = given["receivers"]
    return Options(**{**given, "receivers": None if names is None else tuple(names)})


def _sizes(geometry: Geometry) -> list[int]:
    """What rebuilt geometry must agree in."""
    return [
        len(geometry.fracture.faces),
        len(geometry.element_points),
        geometry.targets.patches.count,
        geometry.targets.columns,
        len(geometry.outlines.vertices),
    ]


def _rebuilt(scene: Scene, options: Options, known: Fingerprint, header, content, threads: int) -> Transfer:
    """A transfer from the scene's geometry and the file's arrays, each of which must fit."""
    times = float(header["times"])
    globe, beams = (Globe(int(header[name])) for name in ("bands", "beams"))
    planes = find_planes(scene)
    geometry = make_geometry(scene, planes, globe, options.max_area, times, options.receivers, beams)
    if header["sizes"] != _sizes(geometry):
        raise ValueError("the scene is cut otherwise now")
    lattice = Nodes.of(geometry.fracture, geometry.lattices)
    patches, columns, elements = geometry.targets.patches.count, geometry.targets.columns, len(geometry.element_points)

    def array(name: str, dtype, *shape: int | None, below: int | None = None) -> np.ndarray:
        values = content[name]
        fits = values.dtype == dtype and values.ndim == len(shape)
        if not fits or any(n is not None and n != m for n, m in zip(shape, values.shape, strict=True)):
            raise ValueError(f"'{name}' is of another shape")
        if below is not None and values.size and not 0 <= values.min() <= values.max() < below:
            raise ValueError(f"'{name}' points nowhere")
        if values.dtype.kind == "f" and not np.isfinite(values).all():
            raise ValueError(f"'{name}' is not finite")
        return values

    if int(array("lattice_nodes", np.int64)) != len(lattice.points):
        raise ValueError("the scene is looked at from other places now")
    points = array("nodes_points", np.float64, None, 3)
    count = len(points)
    weights = [
        Weights(
            array(f"{name}_start", np.int64, elements + 1, below=np.iinfo(np.int64).max),
            array(f"{name}_node", np.int64, None, below=count),
            array(f"{name}_weight", np.float64, None),
        )
        for name in _WEIGHTS
    ]
    for one in weights:
        if (np.diff(one.start) < 0).any() or not one.start[-1] == len(one.node) == len(one.weight):
            raise ValueError("weights do not fit")
    nodes = Nodes(
        points,
        array("nodes_element", np.int64, count, below=elements),
        geometry.fracture.element_sheet,
        weights[0],
        weights[1],
        lattice.centres,
        lattice.foretold,
        lattice.shared,
        lattice.askew,
    )
    sky = {
        name: SparseRows.unpacked(
            (count, columns),
            array(f"{name}_sizes", np.int64, None, 2, below=max(count, columns) + 1),
            array(f"{name}_rows", np.int64, None, below=count),
            array(f"{name}_columns", np.int64, None, below=columns),
            array(f"{name}_values", np.float32, None),
        )
        for name in _SKY
    }
    deep_rows = array("deep_rows", np.int64, None, below=count)
    missing = array("conservation_missing", np.float64, patches)
    of_patches = array("enclosures_of_patches", np.int64, patches, below=max(patches, 1))
    parts = int(of_patches.max(initial=0)) + 1
    enclosures = Enclosures(
        parts,
        of_patches,
        array("enclosures_of_nodes", np.int64, count, below=parts),
        array("enclosures_of_elements", np.int64, elements, below=parts),
    )
    return Transfer(
        geometry=geometry,
        form_factors=array("form_factors", np.float32, count, patches),
        **sky,
        deep_factors=array("deep_factors", np.float32, len(deep_rows), patches),
        deep_rows=deep_rows,
        exchange=Exchange(
            array("exchange_factors", np.float32, patches, patches),
            array("exchange_spread", np.float64, patches),
            missing,
            of_patches,
        ),
        unlit=array("unlit", np.float32, count),
        truncated=array("truncated", np.float32, count),
        nodes=nodes,
        lattice=lattice,
        unsure=array("unsure", np.float64, elements),
        conservation=Conservation(
            geometry.areas_kept,
            array("conservation_lost", np.float64, elements),
            array("conservation_spread", np.float64, count),
            missing,
            array("conservation_beyond", np.float64, patches),
            enclosures,
        ),
        unhidden=bool(header["unhidden"]),
        times=times,
        limits=ChainLimits(options.specular_cutoff, exact_mirrors(geometry.outlines)),
        threads=threads,
        fingerprint=known,
        stages=tuple(Stage(**stage) for stage in header["stages"]),
        findings=inspect(scene, planes),
    )
