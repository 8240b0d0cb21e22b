"""Screens before the Sun's disc: which edges may cut it, and what is left of convex pieces past them.

Whether light from the disc's point (u, v) comes to a point x beside an edge from a to b is the sign of
((a - x) × (b - x)) · d(u, v): affine in x, affine in (u, v). So one set of coefficients per edge gives half-planes of
the disc for points, and half-spaces of the scene for points of the disc; and what holds for the whole disc at the
corners of a face, with the margin that the disc's radius asks for, holds all over the face.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from . import clipping, polygons
from .projection import reflect, reflect_points

_ROUNDING = 1e-12


@dataclass(frozen=True, eq=False)
class Screens:
    """What stands between receivers and the Sun's disc, in the receivers' mirrored space.

    Attributes
    ----------
    vertices : (b, w, 3) float, padded
    window : (b,) bool
        Mirrors on the way, which light has to pass; the others stop it.
    transmittance : (b,) float
    axes : (3, 3) float
        Of the disc: its centre's direction, and two radii.
    tolerance : float
    """

    vertices: np.ndarray
    window: np.ndarray
    transmittance: np.ndarray
    axes: np.ndarray
    tolerance: float
    true: np.ndarray = field(init=False)
    forms: np.ndarray = field(init=False)
    normals: np.ndarray = field(init=False)
    offsets: np.ndarray = field(init=False)
    towards: np.ndarray = field(init=False)
    edge_on: np.ndarray = field(init=False)

    def __post_init__(self):
        after = np.roll(self.vertices, -1, axis=1)
        edge = after - self.vertices
        length = np.linalg.norm(edge, axis=2)
        normal = polygons.newell_normal(self.vertices)
        normal = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
        # (a - x) x (b - x) · d = (a x b) · d - x · ((b - a) x d), for each of the axes d
        offset = polygons.cross(self.vertices, after) @ self.axes.T
        slope = -polygons.cross(edge[:, :, None], self.axes)
        towards = normal @ self.axes.T
        for name, value in (
            ("true", length > self.tolerance * 1e-3),
            ("forms", np.concatenate([offset[..., None], slope], axis=3)),  # (b, w, 3, 4)
            ("normals", normal),
            ("offsets", np.einsum("bc,bc->b", normal, self.vertices.mean(axis=1))),
            ("towards", towards),
            ("edge_on", np.abs(towards[:, 0]) <= np.hypot(towards[:, 1], towards[:, 2])),
        ):
            object.__setattr__(self, name, value)

    def __len__(self) -> int:
        return len(self.vertices)

    def take(self, index) -> Screens:
        """Some of the screens."""
        return replace(
            self,
            vertices=self.vertices[index],
            window=self.window[index],
            transmittance=self.transmittance[index],
        )

    def joined(self, other: Screens) -> Screens:
        """These and others of the same space."""
        width = max(self.vertices.shape[1], other.vertices.shape[1])
        return replace(
            self,
            vertices=np.concatenate([polygons.widen(s.vertices, width) for s in (self, other)]),
            window=np.concatenate([self.window, other.window]),
            transmittance=np.concatenate([self.transmittance, other.transmittance]),
        )

    def reflected(self, normal, offset: float) -> Screens:
        """Their images in a mirror."""
        return replace(self, vertices=reflect_points(self.vertices, normal, offset), axes=reflect(self.axes, normal))

    def relation(self, points) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """How the disc, seen from anywhere within the hulls of points, lies to the screens.

        Parameters
        ----------
        points : (n, c, 3) float
            Corners; what holds at all of them holds between, since an edge's margin is convex over space.

        Returns
        -------
        outside, inside : (b, n) bool
            Wholly beside a screen; wholly behind it. Neither: the disc may be cut.
        ratio : (b, n, w) float
            For edges that may cut it the hull's width over the penumbra's, else NaN.
        """
        n, count = points.shape[:2]
        corners = np.concatenate([np.ones((n, count, 1)), points], axis=2)
        width = self.vertices.shape[1]
        # corners first: NumPy is slow where it reduces over a short last axis
        value = corners.transpose(1, 0, 2).reshape(-1, 4) @ self.forms.reshape(-1, 4).T
        value = np.moveaxis(value.reshape(count, n, len(self), width, 3), 2, 1)
        centre, half = value[..., 0], np.hypot(value[..., 1], value[..., 2])
        height = self.offsets[:, None] - np.einsum("bk,nck->cbn", self.normals, points)
        true = self.true[:, None]
        outside, inside = np.ones((len(self), n), bool), np.zeros((len(self), n), bool)
        for side in (1.0, -1.0):
            mine = self.edge_on | (np.sign(self.towards[:, 0]) == side)
            if not mine.any():
                continue
            beside = (((side * centre + half).max(axis=0) <= 0) & true).any(axis=2)
            beside |= (side * height <= self.tolerance).all(axis=0)
            outside = np.where(mine[:, None], outside & beside, outside)
            behind = (((side * centre - half).min(axis=0) >= 0) | ~true).all(axis=2)
            behind &= (side * height > self.tolerance).all(axis=0)
            inside = np.where((mine & ~self.edge_on)[:, None], behind, inside)
        cuts = ((centre + half).max(axis=0) > 0) & ((centre - half).min(axis=0) < 0) & true
        across = np.maximum(2 * half.mean(axis=0), 1e-300)
        return outside, inside, np.where(cuts, np.ptp(centre, axis=0) / across, np.nan)

    def dimming(self, behind) -> np.ndarray:
        """(n,) float: transmittance of all screens that something is wholly behind, ``behind`` (b, n)."""
        return np.where(behind, self.transmittance[:, None], 1.0).prod(axis=0)

    def lines_at(self, k: int, points) -> np.ndarray:
        """(n, w, 3) float: screen ``k``'s edges as half-planes of the disc, seen from points ``(n, 3)``."""
        form = self.forms[k]
        height = self.offsets[k] - points @ self.normals[k]
        lines = form[..., 0] + np.einsum("wkj,nj->nwk", form[..., 1:], points)
        return np.sign(height)[:, None, None] * lines

    def planes_for(self, k: int, places) -> tuple[np.ndarray, np.ndarray]:
        """Normals (n, w, 3) and offsets (n, w) of screen ``k``'s prisms for points ``(n, 3)`` of the disc."""
        planes = np.einsum("nk,wkj->nwj", places, self.forms[k])
        planes *= np.sign(places @ self.towards[k])[:, None, None]
        return planes[..., 1:], -planes[..., 0]


@dataclass(frozen=True, eq=False)
class Pieces:
    """Convex pieces of what is still lit: of the disc, or of faces.

    Attributes
    ----------
    shapes : (m, v, 3) float, padded
    rows : (m,) int
        Sample that each belongs to.
    factor : (m,) float
    """

    shapes: np.ndarray
    rows: np.ndarray
    factor: np.ndarray

    def take(self, index) -> Pieces:
        """Some of the pieces."""
        return Pieces(self.shapes[index], self.rows[index], self.factor[index])

    @classmethod
    def joined(cls, parts: list[Pieces]) -> Pieces:
        """All pieces in one."""
        parts = [p for p in parts if len(p.rows)] or parts[:1]
        width = max(p.shapes.shape[1] for p in parts)
        return cls(
            np.concatenate([polygons.widen(p.shapes, width) for p in parts]),
            np.concatenate([p.rows for p in parts]),
            np.concatenate([p.factor for p in parts]),
        )

    def parted(self, normals, offsets) -> tuple[Pieces, Pieces]:
        """What of the pieces is inside half-spaces, and what outside: ``normals`` (m, 3), ``offsets`` (m,)."""
        height = np.einsum("mvc,mc->vm", self.shapes, normals) - offsets
        least, most = height.min(axis=0), height.max(axis=0)
        speck = _ROUNDING * np.maximum(most, -least)
        inside, outside = least >= -speck, most <= speck
        outside &= ~inside
        split = ~(inside | outside)
        if not split.any():
            return self.take(inside), self.take(outside)
        both, normals, offsets = self.take(split), normals[split], offsets[split]
        inner = replace(both, shapes=clipping.clip(both.shapes, normals, offsets))
        outer = replace(both, shapes=clipping.clip(both.shapes, -normals, -offsets))
        return Pieces.joined([self.take(inside), inner]), Pieces.joined([self.take(outside), outer])

    def behind(self, screens: Screens, k: int, normals, offsets) -> Pieces:
        """The pieces past screen ``k``, its edges as half-spaces for each sample, ``(n, w, 3)`` and ``(n, w)``."""
        inside, left = self, []
        for edge in np.flatnonzero(screens.true[k]):
            inside, outside = inside.parted(normals[inside.rows, edge], offsets[inside.rows, edge])
            left.append(outside)
        if screens.window[k]:
            return inside
        if screens.transmittance[k] > 0:
            left.append(replace(inside, factor=inside.factor * screens.transmittance[k]))
        return Pieces.joined(left)
