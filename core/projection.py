"""Projection of planes on the globe: which share of a parcel lies on one side of an edge's great circle."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import clipping, polygons
from .globe import Hemisphere

UNTURNED = np.eye(3)
"""What beams that met no mirror are turned by."""

_NO_WIDTH = 1e-100
"""Stands for widths of nought: its cube is still a number."""


@dataclass(frozen=True, eq=False)
class Beams:
    """Parcels as beams that leave every receiver of a group alike.

    Attributes
    ----------
    hemisphere : Hemisphere
        What the beams began in.
    columns : (k,) int
        Index of each beam there.
    turn : (3, 3) float
        What the mirrors on the way made of directions: ``d ← turn @ d``.
    """

    hemisphere: Hemisphere
    columns: np.ndarray
    turn: np.ndarray

    @classmethod
    def of(cls, hemisphere: Hemisphere) -> Beams:
        """All beams of a hemisphere."""
        return cls(hemisphere, np.arange(len(hemisphere.directions)), UNTURNED)

    def take(self, index) -> Beams:
        """Some of the beams."""
        return Beams(self.hemisphere, self.columns[index], self.turn)

    def reflected(self, normal) -> Beams:
        """The beams as a mirror of this unit normal throws them."""
        return Beams(self.hemisphere, self.columns, reflect(self.turn.T, normal).T)

    @cached_property
    def directions(self) -> np.ndarray:
        """(k, 3) float, unit: centres of the beams."""
        return self.hemisphere.directions[self.columns] @ self.turn.T

    @cached_property
    def axes(self) -> np.ndarray:
        """(k, 2, 3) float: unit vectors across each beam."""
        return self.hemisphere.axes[self.columns] @ self.turn.T

    @cached_property
    def frames(self) -> np.ndarray:
        """(k, 3, 3) float: centres of the beams and unit vectors across them, as `Hemisphere.frames`."""
        return self.hemisphere.frames[self.columns] @ self.turn.T

    @cached_property
    def slopes(self) -> np.ndarray:
        """(k, 3) float32: how the beams' weight changes across them, as `Hemisphere.slopes`."""
        return (self.hemisphere.slopes[self.columns] @ self.turn.T).astype(np.float32)

    @cached_property
    def lags(self) -> np.ndarray:
        """(k,) float32: how far each beam's middle, as its sides are arcs, lies behind its centre, in spans."""
        hemisphere = self.hemisphere
        polar = hemisphere.globe.polar[hemisphere.parcels[self.columns]]
        lag = np.cos(polar) / np.sin(polar) * self.half_widths[:, 1] ** 2 / (12 * self.half_widths[:, 0])
        return np.where(self.odd, 0.0, lag).astype(np.float32)

    @cached_property
    def half_widths(self) -> np.ndarray:
        """(k, 2) float [rad]."""
        return self.hemisphere.half_widths[self.columns]

    @cached_property
    def spans(self) -> np.ndarray:
        """(k, 2, 3) float32: vectors from side to side of each beam."""
        return (2 * self.half_widths[:, :, None] * self.axes).astype(np.float32)

    @property
    def odd(self) -> np.ndarray:
        """(k,) bool: beams that a rectangle stands for badly."""
        return self.hemisphere.odd[self.columns]

    @property
    def bent(self) -> np.ndarray:
        """(k,) bool: odd beams, and those that widen much from one end to the other."""
        return self.hemisphere.bent[self.columns]

    def rays(self, index, order: int) -> np.ndarray:
        """(m, F, 3) float32: directions that make up some of the beams, see `Globe.scattered`."""
        rays = self.hemisphere.globe.all_scattered(order)[self.hemisphere.parcels[self.columns[index]]]
        return rays if self.turn is UNTURNED else np.einsum("msc,dc->msd", rays, self.turn.astype(np.float32))

    @property
    def reach(self) -> np.ndarray:
        """(k,) float: no part of a beam is farther than this from its centre [rad]."""
        return self.hemisphere.reach[self.columns]


def reflect(vectors, normal) -> np.ndarray:
    """Mirror images of free vectors ``(..., 3)`` in a plane through the origin of unit ``normal``."""
    v = np.asarray(vectors, float)
    n = np.asarray(normal, float)
    return v - 2 * (v @ n)[..., None] * n


def reflect_points(points, normal, offset: float) -> np.ndarray:
    """Mirror images of points ``(..., 3)`` in the plane ``normal · x = offset``."""
    p = np.asarray(points, float)
    n = np.asarray(normal, float)
    return p - 2 * (p @ n - offset)[..., None] * n


@dataclass(frozen=True, eq=False)
class HalfSpace:
    """Points with ``normal · x > offset``: what lies above a receiver's horizon or beyond a mirror."""

    normal: np.ndarray
    offset: float

    def reflected(self, normal, offset: float) -> HalfSpace:
        """The half-space's image in a mirror."""
        turned = reflect(self.normal, normal)
        origin = reflect_points(np.asarray(self.normal) * self.offset, normal, offset)
        return HalfSpace(turned, float(turned @ origin))


@dataclass(frozen=True, eq=False)
class Obstacles:
    """Convex outlines cut to what can be seen, with the edges that bound them there.

    An edge that lies on a cutting plane bounds nothing that a beam above that plane could reach, so it is left out: a
    wall that stands on a receiver's own plane covers the parcels along the horizon wholly.

    Attributes
    ----------
    outlines : (o,) int
        Index of each obstacle's outline among the scene's.
    vertices : (o, w, 3) float, padded
    bounding : (o, w) bool
        Whether the edge from vertex i to i + 1 bounds the obstacle.
    normals : (o, 3) float
    offsets : (o,) float
    """

    outlines: np.ndarray
    vertices: np.ndarray
    bounding: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray


def obstacles_within(outlines, normals, offsets, half_spaces: list[HalfSpace], tolerance: float) -> Obstacles:
    """Cut outlines to half-spaces.

    Parameters
    ----------
    outlines : (o, w, 3) float, padded convex polygons
    normals : (o, 3) float
    offsets : (o,) float
    half_spaces : list of HalfSpace
    tolerance : float
        Length below which a point counts as lying on a plane [m].

    Returns
    -------
    Obstacles
    """
    index = np.arange(len(outlines))
    vertices = outlines
    for half in half_spaces:
        height = vertices @ half.normal - half.offset
        keep = (height > tolerance).any(axis=1)
        index, vertices, height = index[keep], vertices[keep], height[keep]
        below = (height < -tolerance).any(axis=1)
        if below.any():
            cut = clipping.clip(vertices[below], half.normal, half.offset)
            width = max(cut.shape[1], vertices.shape[1])
            vertices = polygons.widen(vertices, width)
            vertices[below] = polygons.widen(cut, width)
    following = np.roll(vertices, -1, axis=1)
    bounding = np.linalg.norm(following - vertices, axis=2) > 1e-3 * tolerance
    for half in half_spaces:
        low = vertices @ half.normal - half.offset <= tolerance
        bounding &= ~(low & np.roll(low, -1, axis=1))
    return Obstacles(index, vertices, bounding, normals[index], offsets[index])


def edge_planes(points, obstacles: Obstacles, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """Unit normals of the planes through each point and each edge, positive inside the obstacle as seen from the point.

    Parameters
    ----------
    points : (r, 3) float
    obstacles : Obstacles
    tolerance : float [m]

    Returns
    -------
    planes : (r, o, w, 3) float
        For edges that bound nothing the zero vector.
    heights : (r, o) float
        Signed distance along the obstacle's normal from the point to its plane; 0 where the point lies in it.
    """
    p = np.asarray(points, float)
    relative = obstacles.vertices[None] - p[:, None, None]
    planes = polygons.cross(relative, np.roll(relative, -1, axis=2))
    length = np.linalg.norm(planes, axis=3, keepdims=True)
    heights = obstacles.offsets[None] - p @ obstacles.normals.T
    heights[np.abs(heights) <= tolerance] = 0.0
    # seen from the front (height < 0) a right-handed outline runs so that its inside is on the negative side
    sign = np.sign(heights)[:, :, None, None]
    usable = (length > 0) & obstacles.bounding[None, :, :, None]
    return np.where(usable, planes * sign / np.where(length > 0, length, 1.0), 0.0), heights


def coverage(distance, width_a, width_b) -> tuple[np.ndarray, np.ndarray]:
    """Share of a rectangle on the positive side of a line, and where its centre lies.

    The rectangle projects on the line's normal as the convolution of two boxes, so the share is a difference of
    squared ramps: exact for a straight edge.

    Parameters
    ----------
    distance : (n,) float
        Signed distance from the line to the rectangle's centre, positive inside.
    width_a, width_b : (n,) float
        Full widths of the two boxes: the rectangle's sides projected on the line's normal.

    Returns
    -------
    share : (n,) float, 0 to 1
    moment : (n,) float
        Share times the distance of its centroid from the rectangle's centre, along the line's normal.
    """
    floor = np.maximum(1e-4 * (width_a + width_b), _NO_WIDTH)
    p, q = np.maximum(width_a, floor), np.maximum(width_b, floor)
    alpha, beta = 0.5 * (p + q), 0.5 * np.abs(p - q)
    s = np.clip(distance, -alpha, alpha)
    ramps = [np.maximum(s + alpha, 0), np.maximum(s + beta, 0), np.maximum(s - beta, 0)]
    second = (ramps[0] ** 2 - ramps[1] ** 2 - ramps[2] ** 2) / (2 * p * q)
    cubes = [ramp * ramp * ramp for ramp in ramps]  # powers are slow
    third = (cubes[0] - cubes[1] - cubes[2]) / (6 * p * q)
    share = np.clip(second, 0.0, 1.0)
    return share, third - s * second
