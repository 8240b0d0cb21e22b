"""Embree and the solver along the same directions: receivers × parcels above their horizon, the nearest surface.

Embree (the embreex wheel) gets the rays as arrays made beforehand; making them is not counted. It runs in as many
processes as the solver has threads, each with its share of the receivers, since its calls do not let other threads of
Python run.
"""

from __future__ import annotations

import importlib.util
import multiprocessing
import time
from dataclasses import dataclass, replace

import apart
import numpy as np
import rooms

import luzespecular as luz
from luzespecular import form_factors
from luzespecular.gather import gather
from luzespecular.geometry import sight_of
from luzespecular.parallel import chunks_of_receivers, run_parallel
from luzespecular.projection import Beams, HalfSpace, Obstacles, obstacles_within
from luzespecular.specular import GroupSight
from luzespecular.views import View
from luzespecular.visibility import look

OFF_THE_PLANE = 1e-4
"""Rays start so far before their receiver's plane, which in single precision they would meet otherwise [m]."""

NO_WIDTH = 1e-6 / 1.01
"""What the solver adds to how far beams reach, so that nothing slips by: taken off again [rad]."""


def available() -> bool:
    """Whether Embree is installed."""
    return importlib.util.find_spec("embreex") is not None


@dataclass(frozen=True)
class Group:
    """Receivers that look together, along the same directions."""

    points: np.ndarray
    sight: GroupSight

    @property
    def directions(self) -> np.ndarray:
        """(k, 3) float: centres of the parcels above their horizon."""
        return self.sight.hemisphere.directions

    @property
    def rays(self) -> int:
        """How many receiver-directions they have."""
        return len(self.points) * len(self.directions)


def groups_of(transfer: luz.Transfer, globe: luz.Globe) -> list[Group]:
    """All receivers of a transfer in groups as large as those in which `prepare` looks, along a globe's parcels."""
    geometry, nodes = transfer.geometry, transfer.nodes
    most = max(8, form_factors._CHUNK_CELLS // max(globe.count // 2, 1))
    sights: dict[int, GroupSight] = {}
    groups = []
    for chunk in chunks_of_receivers(nodes.points, nodes.sheet, geometry.planes, most):
        sheet, first = int(nodes.sheet[chunk[0]]), chunk[0]
        if sheet not in sights:
            normal = geometry.element_normals[nodes.element[first]]
            sights[sheet] = sight_of(geometry, transfer.limits, normal, float(normal @ nodes.points[first]), globe)
        groups.append(Group(nodes.points[chunk], sights[sheet]))
    return groups


@dataclass(frozen=True)
class Rays:
    """A group's parcels as single rays through their middles, and what these may meet."""

    group: Group
    beams: Beams
    obstacles: Obstacles

    @classmethod
    def of(cls, group: Group) -> Rays:
        """Beams without width: no edge crosses one, but for what rounding does."""
        sight, outlines = group.sight, group.sight.outlines
        thin = replace(sight.hemisphere, reach=np.full(len(sight.hemisphere.reach), -NO_WIDTH))
        horizon = HalfSpace(sight.hemisphere.normal, sight.offset)
        obstacles = obstacles_within(
            outlines.vertices, outlines.normals, outlines.offsets, [horizon], outlines.tolerance
        )
        return cls(group, Beams.of(thin), obstacles)

    def look(self) -> View:
        """The nearest outline along each ray."""
        tolerance, normal = self.group.sight.outlines.tolerance, self.beams.hemisphere.normal
        return look(self.group.points, normal, self.beams, self.obstacles, tolerance)


def look_along_rays(rays: list[Rays], threads: int) -> None:
    """What Embree is asked: the nearest surface along the middle of each parcel."""
    run_parallel(lambda some, _: some.look(), rays, threads, _unheard)


def look_straight(groups: list[Group], threads: int) -> None:
    """Visibility alone, no mirrors: the first sighting of each group."""
    run_parallel(lambda group, _: next(iter(group.sight.sightings(group.points)[0])), groups, threads, _unheard)


def look_all(groups: list[Group], threads: int) -> None:
    """Visibility with all that is seen in mirrors."""

    def work(group: Group, _) -> None:
        for _sighting in group.sight.sightings(group.points)[0]:
            pass

    run_parallel(work, groups, threads, _unheard)


def gather_all(groups: list[Group], transfer: luz.Transfer, threads: int) -> None:
    """Form factors: visibility with mirrors, and what each direction ends on added up."""
    targets = transfer.geometry.targets
    run_parallel(lambda group, _: gather(group.sight, group.points, targets), groups, threads, _unheard)


def directions_in_mirrors(groups: list[Group]) -> int:
    """Receiver-directions of all sightings, those that came by a mirror as well."""
    count = 0
    for group in groups:
        for sighting in group.sight.sightings(group.points)[0]:
            count += len(sighting.rows) if sighting.rays else int(np.count_nonzero(sighting.weights))
    return count


def triangles(outlines: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Convex outlines ``(o, w, 3)`` as triangles ``(t, 3, 3)``, and which outline each is of ``(t,)``."""
    corners, owner = [], []
    for o, outline in enumerate(outlines):
        for k in range(1, len(outline) - 1):
            triangle = outline[[0, k, k + 1]]
            if np.linalg.norm(np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])) > 1e-12:  # not padding
                corners.append(triangle)
                owner.append(o)
    return np.array(corners), np.array(owner)


def rays_of(group: Group) -> tuple[np.ndarray, np.ndarray]:
    """Origins and directions of all rays of a group, both (n, 3) float32, receiver after receiver."""
    origins = (group.points + OFF_THE_PLANE * group.sight.hemisphere.normal).astype(np.float32)
    directions = group.directions.astype(np.float32)
    return np.repeat(origins, len(directions), axis=0), np.tile(directions, (len(origins), 1))


def _scene(corners: np.ndarray):
    from embreex.mesh_construction import TriangleMesh
    from embreex.rtcore_scene import EmbreeScene

    scene = EmbreeScene()
    TriangleMesh(scene, corners.astype(np.float32))
    return scene


def _worker(pipe, corners: np.ndarray, lots: list[tuple[np.ndarray, np.ndarray]]) -> None:
    """Trace the lots whenever told to; answer when it began and ended."""
    scene = _scene(corners)
    scene.run(*(rays[:1] for rays in lots[0]))  # builds what Embree looks things up in
    pipe.send("ready")
    while pipe.recv():
        begun = time.perf_counter()
        for origins, directions in lots:
            scene.run(origins, directions)
        pipe.send((begun, time.perf_counter()))


class Embree:
    """Embree in processes that wait to be told."""

    def __init__(self, corners: np.ndarray, groups: list[Group], processes: int):
        self.pipes, self.processes = [], []
        for k in range(processes):
            mine, theirs = multiprocessing.Pipe()
            lots = [rays_of(group) for group in groups[k::processes]]
            process = multiprocessing.Process(target=_worker, args=(theirs, corners, lots), daemon=True)
            process.start()
            self.pipes.append(mine)
            self.processes.append(process)
        for pipe in self.pipes:
            pipe.recv()

    def run(self) -> float:
        """Trace all rays; seconds from the first one's start to the last one's end."""
        for pipe in self.pipes:
            pipe.send(True)
        spans = [pipe.recv() for pipe in self.pipes]
        return max(end for _, end in spans) - min(begun for begun, _ in spans)

    def close(self) -> None:
        """End the processes."""
        for pipe, process in zip(self.pipes, self.processes, strict=True):
            pipe.send(False)
            process.join()


def agreement(transfer: luz.Transfer, groups: list[Group]) -> float:
    """Share of the rays along parcels that no edge crosses which Embree and the solver see end on the same outline."""
    corners, owner = triangles(transfer.geometry.outlines.vertices)
    scene, same, count = _scene(corners), 0, 0
    for group in groups:
        sighting = next(iter(group.sight.sightings(group.points)[0]))
        hit = np.asarray(scene.run(*rays_of(group))).reshape(len(group.points), -1)
        theirs = np.where(hit >= 0, owner[hit], -1)
        seen = np.asarray(sighting.view.seen)
        ours = np.where(seen >= 0, sighting.obstacles.outlines[seen], seen)
        whole = ours >= -1
        same, count = same + int((theirs == ours)[whole].sum()), count + int(whole.sum())
    return same / count


def agreement_along_rays(transfer: luz.Transfer, rays: list[Rays]) -> float:
    """Share of all rays which Embree and the solver see end on the same outline, or on none."""
    corners, owner = triangles(transfer.geometry.outlines.vertices)
    scene, same, count = _scene(corners), 0, 0
    for some in rays:
        seen = np.asarray(some.look().seen)
        hit = np.asarray(scene.run(*rays_of(some.group))).reshape(seen.shape)
        ours = np.where(seen >= 0, some.obstacles.outlines[seen], seen)
        same, count = same + int((np.where(hit >= 0, owner[hit], -1) == ours).sum()), count + seen.size
    return same / count


def compare(bands: int, max_area: float, threads: int, repeats: int, most_seconds: float) -> dict:
    """Directions per second of Embree and of the solver in the light-shelf room, in turn."""
    transfer = luz.prepare(rooms.light_shelf_room().scene("S1"), bands=bands, max_area=max_area, threads=threads)
    groups = groups_of(transfer, transfer.geometry.targets.globe)
    rays = [Rays.of(group) for group in groups]
    works = {
        "nearest surface alone": lambda: look_along_rays(rays, threads),
        "visibility": lambda: look_straight(groups, threads),
        "visibility, mirrors as well": lambda: look_all(groups, threads),
        "form factors, mirrors as well": lambda: gather_all(groups, transfer, threads),
    }
    corners, _ = triangles(transfer.geometry.outlines.vertices)
    embree = Embree(corners, groups, threads) if available() else None
    if embree is not None:
        works = {"Embree": embree.run} | works
    try:
        seconds, runs = apart.medians(works, repeats, most_seconds)
    finally:
        if embree is not None:
            embree.close()
    straight = sum(group.rays for group in groups)
    every = directions_in_mirrors(groups)
    counted = {name: every if "mirrors" in name else straight for name in works}
    out = {
        "receivers": len(transfer.nodes.points),
        "parcels": len(groups[0].directions),
        "triangles": len(corners),
        "runs": runs,
        "rows": [
            {"what": name, "directions": counted[name], "seconds": seconds[name], "rate": counted[name] / seconds[name]}
            for name in works
        ],
    }
    if embree is not None:
        some = slice(None, None, max(1, len(groups) // 8))
        out["agree"] = agreement(transfer, groups[some])
        out["agree_rays"] = agreement_along_rays(transfer, rays[some])
    return out


def _unheard(_: float) -> None:
    """Progress that nobody listens to."""
