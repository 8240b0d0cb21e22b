"""The legend in renders and pictures: one flat mesh before the camera, in colours of its own.

Texts are faces too, so that it needs no other material than the one that shows all else there. The mesh is laid out in
units of its letters' size; what fits it into the picture is the object's place and scale.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from bpy.app.translations import pgettext_iface as iface_
from mathutils import Matrix
from numpy.typing import NDArray

from . import colours, legend, mesh_arrays, own_objects, writeback

NAME = "LuzEspecular legend"
SIDE = "legend"

FLAG = "luzespecular_legend"
"""FLOAT attribute of the CORNER domain: 1 where shaders show the colour attribute as it is."""

CAMERA_TYPES = ("PERSP", "ORTHO")
"""Cameras that a flat legend can stand before."""

_PAPER, _INK = (0.06, 0.06, 0.06), (0.95, 0.95, 0.95)  # sRGB
_PADDING, _LINE, _WIDTH, _HEIGHT, _GAP = 0.8, 1.5, 1.4, 16.0, 0.7
_STEPS = 64
_BEHIND = 0.05  # the panel, behind what is written on it
_NEAR = 1.01  # of the nearest that the camera sees
_MARGIN = 0.02  # of the picture's height
_WIDEST = 0.9  # of the picture's width
_ROUNDING = 1e-5


def find(scene: bpy.types.Scene) -> bpy.types.Object | None:
    """Return the object of the legend, if there is one."""
    return own_objects.find(scene, SIDE)


def update(scene: bpy.types.Scene, scale: colours.ColourScale, wanted: bool) -> None:
    """Bring a scene's legend in step with what is shown, or take it away."""
    if not wanted:
        remove(scene)
        return
    object_, words = find(scene), Words.of(scene, scale)
    if object_ is None:
        object_ = own_objects.new(scene, NAME, SIDE, new_mesh(words, scale.name))
        for ray in ("diffuse", "glossy", "transmission", "volume_scatter", "shadow"):
            setattr(object_, f"visible_{ray}", False)
        own_objects.hide(scene, object_)  # a viewport draws a legend of its own
    elif object_.luzespecular.state != words.state(scale.name):
        before, object_.data = object_.data, new_mesh(words, scale.name)
        bpy.data.meshes.remove(before)
    object_.luzespecular.state = words.state(scale.name)
    stand(object_, scene, scene.luzespecular.display)


def follow(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Keep the legend where it stands in the picture, whatever has become of the camera, its lens or the picture."""
    settings = scene.luzespecular
    if settings.is_property_set("results") and settings.results.renders:  # asking alone would make an empty group
        object_ = find(scene)
        if object_ is not None:
            stand(object_, scene, settings.display, depsgraph)


def remove(scene: bpy.types.Scene) -> None:
    """Delete the legend's object and mesh."""
    own_objects.remove(scene, (SIDE,))


def stand(
    object_: bpy.types.Object,
    scene: bpy.types.Scene,
    settings: bpy.types.PropertyGroup,
    depsgraph: bpy.types.Depsgraph | None = None,
) -> None:
    """Put a legend upright before the scene's camera, nearer than all else; changes nothing that is right already."""
    camera = scene.camera
    usable = camera is not None and camera.type == "CAMERA" and camera.data.type in CAMERA_TYPES
    if object_.hide_render == usable:
        object_.hide_render = not usable
    if not usable:
        return
    seen = camera if depsgraph is None else camera.evaluated_get(depsgraph)
    if object_.parent != camera:
        object_.parent = camera
    straight = Matrix.LocRotScale(*seen.matrix_world.decompose()[:2], None)  # cameras see without their scale
    _set(object_, "matrix_parent_inverse", seen.matrix_world.inverted_safe() @ straight)
    _set(object_, "matrix_basis", _place(scene, seen.data, settings, *_extent(object_.data)))


def _set(object_: bpy.types.Object, name: str, matrix: Matrix) -> None:
    before, after = np.array(getattr(object_, name)), np.array(matrix)
    if np.abs(before - after).max() > _ROUNDING * np.abs(after[:3]).min(initial=1.0, where=after[:3] != 0.0):
        setattr(object_, name, matrix)


def _place(scene: bpy.types.Scene, camera: bpy.types.Camera, settings, width: float, height: float) -> Matrix:
    """Place and scale of a legend of a width and height in the camera's space."""
    frame = np.array(camera.view_frame(scene=scene))
    distance = _NEAR * camera.clip_start
    if camera.type == "PERSP":
        frame *= distance / -frame[0, 2]
    (left, bottom), (right, top) = frame[:, :2].min(axis=0), frame[:, :2].max(axis=0)
    scale = min(0.01 * settings.legend_size * (top - bottom) / height, _WIDEST * (right - left) / width)
    margin = _MARGIN * (top - bottom)
    x = left + margin if "LEFT" in settings.legend_corner else right - margin - scale * width
    y = bottom + margin if "BOTTOM" in settings.legend_corner else top - margin - scale * height
    return Matrix.LocRotScale((x, y, -distance), None, (scale, scale, scale))


def _extent(mesh: bpy.types.Mesh) -> tuple[float, float]:
    """Width and height of a legend; its panel comes first."""
    corner = mesh.vertices[2].co
    return corner.x, corner.y


@dataclass(frozen=True)
class Words:
    """What a legend says.

    Attributes
    ----------
    heading : tuple of str
        Line by line.
    ticks : tuple of (float, str)
        Place on the bar, 0 to 1, and value.
    missing : str
        Beside what stands for faces that were not computed.
    """

    heading: tuple[str, ...]
    ticks: tuple[tuple[float, str], ...]
    missing: str

    @classmethod
    def of(cls, scene: bpy.types.Scene, scale: colours.ColourScale) -> Words:
        """Words for what a scene shows."""
        heading = (legend.title(scene), *scene.luzespecular.results.title.split("\n"))
        return cls(heading, tuple(legend.entries(scale)), iface_("not computed"))

    def state(self, scale_name: str) -> str:
        """Return a text that changes with all that the legend looks like."""
        return repr((scale_name, self))


def new_mesh(words: Words, scale_name: str) -> bpy.types.Mesh:
    """Lay a legend out, its lower left corner at the origin, looking to +Z."""
    fonts = set(bpy.data.fonts)
    values = [text for _, text in words.ticks]
    texts = {text: _letters(text) for text in {*words.heading, words.missing, *values}}
    for font in set(bpy.data.fonts) - fonts:
        bpy.data.fonts.remove(font)
    sheet = _Sheet()
    beside = _WIDTH + _GAP + max(_width(texts[text]) for text in (words.missing, *values))
    width = 2 * _PADDING + max(beside, *(_width(texts[text]) for text in words.heading))
    bottom = _PADDING + 1.5 * _LINE
    height = bottom + _HEIGHT + (len(words.heading) + 0.3) * _LINE + _PADDING
    sheet.rectangle(0.0, 0.0, width, height, _PAPER, depth=_BEHIND)
    edges = np.linspace(0.0, 1.0, _STEPS + 1)
    of_edges = colours.scale_colours(scale_name, edges)
    for low, high, below, above in zip(edges, edges[1:], of_edges, of_edges[1:], strict=False):
        sheet.rectangle(_PADDING, bottom + low * _HEIGHT, _WIDTH, (high - low) * _HEIGHT, below, above)
    right = _PADDING + _WIDTH
    for position, text in words.ticks:
        y = bottom + position * _HEIGHT
        sheet.rectangle(right, y - 0.04, 0.5 * _GAP, 0.08, _INK)
        sheet.write(texts[text], right + _GAP, y - 0.35)
    sheet.write(texts[words.missing], right + _GAP, _PADDING + 0.2)
    for row, text in enumerate(reversed(words.heading)):
        sheet.write(texts[text], _PADDING, bottom + _HEIGHT + (row + 0.8) * _LINE)
    sheet.hatch(_PADDING, _PADDING, _WIDTH, _LINE - 0.3)
    return sheet.mesh()


def _letters(words: str) -> NDArray[np.float32]:
    """Triangles of a text of size 1 from the origin, (t, 3, 3)."""
    curve = bpy.data.curves.new(NAME, "FONT")
    curve.body, curve.resolution_u = words, 4
    holder = bpy.data.objects.new(NAME, curve)
    mesh = bpy.data.meshes.new_from_object(holder)
    found = mesh_arrays.read_triangles(mesh)
    bpy.data.objects.remove(holder)
    bpy.data.curves.remove(curve)
    bpy.data.meshes.remove(mesh)
    return found.positions[found.triangles]


def _width(letters: NDArray[np.float32]) -> float:
    return float(letters[..., 0].max(initial=0.0))


class _Sheet:
    """Flat pieces in scene-linear colours, which become one mesh of triangles."""

    def __init__(self):
        self._triangles: list[NDArray] = []
        self._colours: list[NDArray] = []
        self._plain = 0

    def rectangle(self, left: float, bottom: float, width: float, height: float, below, above=None, depth=0.0) -> None:
        """Add a rectangle, sRGB colours at its lower and its upper edge."""
        right, top = left + width, bottom + height
        quad = np.array([(left, bottom, -depth), (right, bottom, -depth), (right, top, -depth), (left, top, -depth)])
        rgb = colours.srgb_to_linear([below, below, *[below if above is None else above] * 2])
        corners = [[0, 1, 2], [0, 2, 3]]
        self._add(quad[corners], rgb[corners])

    def write(self, letters: NDArray, x: float, y: float) -> None:
        """Add a text from a point on its base line."""
        self._add(letters + np.array([x, y, 0.0]), np.broadcast_to(colours.srgb_to_linear(_INK), letters.shape))

    def hatch(self, left: float, bottom: float, width: float, height: float) -> None:
        """Add, last of all, a rectangle that looks as faces do that were not computed."""
        self._plain = sum(map(len, self._triangles))
        dark, light = colours.NOT_COMPUTED_SRGB
        self.rectangle(left, bottom, width, height, dark, light)

    def mesh(self) -> bpy.types.Mesh:
        """Make the mesh."""
        triangles = np.concatenate(self._triangles)
        mesh = mesh_arrays.new_triangle_mesh(NAME, triangles)
        rgba = np.ones((3 * len(triangles), 4))
        rgba[:, :3] = np.concatenate(self._colours).reshape(-1, 3)
        mesh_arrays.write_corner_colours(mesh, writeback.COLOURS, rgba)
        mesh_arrays.write_corner_floats(mesh, FLAG, np.arange(len(rgba)) < 3 * self._plain)
        return mesh

    def _add(self, triangles: NDArray, linear: NDArray) -> None:
        self._triangles.append(triangles)
        self._colours.append(linear)
