"""NumPy arrays in and out of Blender meshes: the only room that touches ``foreach_get`` and ``foreach_set``.

Buffers are C-contiguous and of the type that Blender stores, so that each call is one copy of memory.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class TriangulatedMesh:
    """A mesh cut into triangles, with the polygon each triangle comes from.

    Attributes
    ----------
    positions : (v, 3) float32
        Vertex positions in object space, Blender units.
    triangles : (t, 3) int32
        Vertex indices; normals by the right-hand rule.
    polygons : (t,) int32
        Polygon of each triangle.
    material_indices : (p,) int32
        Material slot of each polygon.
    closed : bool
        Whether every edge belongs to exactly two polygons.
    """

    positions: NDArray[np.float32]
    triangles: NDArray[np.int32]
    polygons: NDArray[np.int32]
    material_indices: NDArray[np.int32]
    closed: bool


def read_triangles(mesh: bpy.types.Mesh) -> TriangulatedMesh:
    """Read a mesh as triangles (concave polygons are tessellated by Blender, area exact)."""
    mesh.calc_loop_triangles()
    positions = np.empty((len(mesh.vertices), 3), np.float32)
    triangles = np.empty((len(mesh.loop_triangles), 3), np.int32)
    polygons = np.empty(len(mesh.loop_triangles), np.int32)
    if len(positions):
        mesh.attributes["position"].data.foreach_get("vector", positions.reshape(-1))
    if len(triangles):
        mesh.loop_triangles.foreach_get("vertices", triangles.reshape(-1))
        mesh.loop_triangle_polygons.foreach_get("value", polygons)
    materials = read_face_values(mesh, "material_index", np.int32)
    if materials is None:
        materials = np.zeros(len(mesh.polygons), np.int32)
    return TriangulatedMesh(positions, triangles, polygons, materials, _is_closed(mesh))


def _is_closed(mesh: bpy.types.Mesh) -> bool:
    uses = np.bincount(corner_edges(mesh), minlength=len(mesh.edges))
    return bool(len(mesh.loops) and np.all(uses == 2))


def corner_counts(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """Return the number of corners of each polygon, (p,) int32."""
    if len(mesh.loops) == 3 * len(mesh.polygons):  # no polygon has less
        return np.full(len(mesh.polygons), 3, np.int32)
    starts = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_start", starts)
    return np.diff(starts, append=np.int32(len(mesh.loops)))


def polygon_areas(mesh: bpy.types.Mesh) -> NDArray[np.float32]:
    """Return the area of each polygon, (p,) float32, Blender units squared."""
    areas = np.empty(len(mesh.polygons), np.float32)
    mesh.polygons.foreach_get("area", areas)
    return areas


def polygon_normals(mesh: bpy.types.Mesh) -> NDArray[np.float32]:
    """Return the unit normal of each polygon, (p, 3) float32, object space."""
    normals = np.empty((len(mesh.polygons), 3), np.float32)
    mesh.polygon_normals.foreach_get("vector", normals.reshape(-1))
    return normals


def polygon_centres(mesh: bpy.types.Mesh) -> NDArray[np.float32]:
    """Return the centre of each polygon, (p, 3) float32, object space."""
    centres = np.empty((len(mesh.polygons), 3), np.float32)
    mesh.polygons.foreach_get("center", centres.reshape(-1))
    return centres


def vertex_positions(mesh: bpy.types.Mesh) -> NDArray[np.float32]:
    """Return the position of each vertex, (v, 3) float32, object space."""
    positions = np.empty((len(mesh.vertices), 3), np.float32)
    if len(positions):
        mesh.attributes["position"].data.foreach_get("vector", positions.reshape(-1))
    return positions


def corner_vertices(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """Return the vertex of each corner, (l,) int32."""
    vertices = np.empty(len(mesh.loops), np.int32)
    if len(vertices):
        mesh.attributes[".corner_vert"].data.foreach_get("value", vertices)
    return vertices


def corner_edges(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """Return the edge that begins at each corner, (l,) int32."""
    edges = np.empty(len(mesh.loops), np.int32)
    if len(edges):
        mesh.attributes[".corner_edge"].data.foreach_get("value", edges)
    return edges


def select_faces(mesh: bpy.types.Mesh, faces: NDArray[np.integer]) -> None:
    """Select some faces with their edges and vertices, and nothing else; where any of them are hidden, all are shown.

    The mesh must not be in Edit Mode.
    """
    chosen, hidden = (np.zeros(len(mesh.polygons), bool) for _ in range(2))
    chosen[faces] = True
    mesh.polygons.foreach_get("hide", hidden)
    corners = np.repeat(chosen, corner_counts(mesh))
    active = active_names(mesh)
    for name, domain, used in (
        ("vert", "POINT", (len(mesh.vertices), corner_vertices(mesh)[corners])),
        ("edge", "EDGE", (len(mesh.edges), corner_edges(mesh)[corners])),
        ("poly", "FACE", (len(mesh.polygons), faces)),
    ):
        flags = np.zeros(used[0], bool)
        flags[used[1]] = True
        # Made anew, since Blender 5.0 writes to nowhere where it made those of new edges itself.
        remove_attribute(mesh, f".select_{name}")
        mesh.attributes.new(f".select_{name}", "BOOLEAN", domain).data.foreach_set("value", flags)
        if hidden[faces].any():
            remove_attribute(mesh, f".hide_{name}")
    restore_active(mesh, active)


def triangle_corners(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """Return the corners of the triangles that a mesh is cut into, (t, 3) int32."""
    if len(mesh.loops) == 3 * len(mesh.polygons):  # nothing to cut
        return np.arange(len(mesh.loops), dtype=np.int32).reshape(-1, 3)
    mesh.calc_loop_triangles()
    corners = np.empty((len(mesh.loop_triangles), 3), np.int32)
    if len(corners):
        mesh.loop_triangles.foreach_get("loops", corners.reshape(-1))
    return corners


def read_face_values(mesh: bpy.types.Mesh, name: str, dtype: type) -> NDArray | None:
    """Read a FLOAT or INT attribute of the FACE domain, (p,); None where there is no such attribute."""
    attribute = mesh.attributes.get(name)
    if attribute is None or attribute.domain != "FACE" or len(attribute.data) != len(mesh.polygons):
        return None
    values = np.empty(len(mesh.polygons), dtype)
    attribute.data.foreach_get("value", values)
    return values


def face_value(mesh: bpy.types.Mesh, name: str, face: int) -> float | None:
    """Return the value of one face in a FLOAT or INT attribute of the FACE domain; None without one, and for NaN."""
    attribute = mesh.attributes.get(name)
    if attribute is None or attribute.domain != "FACE" or not 0 <= face < len(attribute.data):
        return None
    value = float(attribute.data[face].value)
    return None if np.isnan(value) else value


def write_face_floats(mesh: bpy.types.Mesh, name: str, values: NDArray) -> None:
    """Write (p,) floats as a FLOAT attribute of the FACE domain, made anew if absent."""
    _attribute(mesh, name, "FLOAT", "FACE").data.foreach_set("value", np.ascontiguousarray(values, np.float32))


def write_face_integers(mesh: bpy.types.Mesh, name: str, values: NDArray) -> None:
    """Write (p,) integers as an INT attribute of the FACE domain, made anew if absent."""
    _attribute(mesh, name, "INT", "FACE").data.foreach_set("value", np.ascontiguousarray(values, np.int32))


def write_corner_floats(mesh: bpy.types.Mesh, name: str, values: NDArray) -> None:
    """Write (l,) floats as a FLOAT attribute of the CORNER domain, made anew if absent."""
    _attribute(mesh, name, "FLOAT", "CORNER").data.foreach_set("value", np.ascontiguousarray(values, np.float32))


def read_corner_floats(mesh: bpy.types.Mesh, name: str) -> NDArray[np.float32] | None:
    """Read a FLOAT attribute of the CORNER domain, (l,); None where there is no such attribute."""
    return _read(mesh, name, "CORNER", "value", (len(mesh.loops),))


def write_corner_colours(mesh: bpy.types.Mesh, name: str, colours: NDArray) -> None:
    """Write (l, 4) scene-linear colours as a FLOAT_COLOR attribute of the CORNER domain, made anew if absent."""
    attribute = mesh.color_attributes.get(name)
    if attribute is None:
        attribute = mesh.color_attributes.new(name, "FLOAT_COLOR", "CORNER")
    attribute.data.foreach_set("color", np.ascontiguousarray(colours, np.float32).reshape(-1))


def read_corner_colours(mesh: bpy.types.Mesh, name: str) -> NDArray[np.float32] | None:
    """Read the scene-linear colours of a CORNER colour attribute, (l, 4); None where there is none."""
    attribute = mesh.color_attributes.get(name)
    if attribute is None or attribute.domain != "CORNER":
        return None
    colours = np.empty((len(mesh.loops), 4), np.float32)
    attribute.data.foreach_get("color", colours.reshape(-1))
    return colours


def remove_attribute(mesh: bpy.types.Mesh, name: str) -> None:
    """Remove an attribute if the mesh has it."""
    attribute = mesh.attributes.get(name)
    if attribute is not None:
        mesh.attributes.remove(attribute)


def new_mesh(name: str, vertices: NDArray, corners: NDArray, starts: NDArray) -> bpy.types.Mesh:
    """Make a mesh of polygons.

    Parameters
    ----------
    name : str
    vertices : (v, 3) float
        Blender units.
    corners : (l,) int
        Vertex of each corner, the corners of a polygon one after another.
    starts : (p,) int
        First corner of each polygon.
    """
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(vertices))
    mesh.loops.add(len(corners))
    mesh.polygons.add(len(starts))
    if len(starts):
        mesh.attributes["position"].data.foreach_set("vector", np.ascontiguousarray(vertices, np.float32).reshape(-1))
        mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(corners, np.int32))
        mesh.polygons.foreach_set("loop_start", np.ascontiguousarray(starts, np.int32))
        mesh.update(calc_edges=True)
    return mesh


def new_triangle_mesh(name: str, vertices: NDArray) -> bpy.types.Mesh:
    """Make a mesh of separate triangles from (n, 3, 3) positions in Blender units."""
    count = 3 * len(vertices)
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(count)
    mesh.edges.add(count)
    mesh.loops.add(count)
    mesh.polygons.add(len(vertices))
    if count:
        corners = np.arange(count, dtype=np.int32)
        # Each corner has an edge of its own: Blender's search for edges would take several times as long as all else.
        edges = np.column_stack([corners, corners.reshape(-1, 3)[:, [1, 2, 0]].reshape(-1)])
        mesh.attributes["position"].data.foreach_set("vector", np.ascontiguousarray(vertices, np.float32).reshape(-1))
        mesh.attributes[".corner_vert"].data.foreach_set("value", corners)
        mesh.attributes[".corner_edge"].data.foreach_set("value", corners)
        mesh.attributes[".edge_verts"].data.foreach_set("value", edges.reshape(-1))
        mesh.polygons.foreach_set("loop_start", np.ascontiguousarray(corners[::3]))
        mesh.update()
    return mesh


def replace_edges(mesh: bpy.types.Mesh, ends: NDArray) -> None:
    """Make a mesh one of separate edges between (k, 2, 3) positions in Blender units, whatever it was before."""
    count = len(ends)
    mesh.clear_geometry()
    mesh.vertices.add(2 * count)
    mesh.edges.add(count)
    if count:
        mesh.attributes["position"].data.foreach_set("vector", np.ascontiguousarray(ends, np.float32).reshape(-1))
        mesh.edges.foreach_set("vertices", np.arange(2 * count, dtype=np.int32))


def edge_ends(mesh: bpy.types.Mesh) -> NDArray[np.float32]:
    """Return the ends of the edges that `replace_edges` made, (k, 2, 3) float32."""
    return vertex_positions(mesh).reshape(-1, 2, 3)


def write_edge_floats(mesh: bpy.types.Mesh, name: str, values: NDArray) -> None:
    """Write (e,) floats as a FLOAT attribute of the EDGE domain, made anew if absent."""
    _attribute(mesh, name, "FLOAT", "EDGE").data.foreach_set("value", np.ascontiguousarray(values, np.float32))


def write_edge_vectors(mesh: bpy.types.Mesh, name: str, values: NDArray) -> None:
    """Write (e, 3) floats as a FLOAT_VECTOR attribute of the EDGE domain, made anew if absent."""
    flat = np.ascontiguousarray(values, np.float32).reshape(-1)
    _attribute(mesh, name, "FLOAT_VECTOR", "EDGE").data.foreach_set("vector", flat)


def read_edge_vectors(mesh: bpy.types.Mesh, name: str) -> NDArray[np.float32] | None:
    """Read a FLOAT_VECTOR attribute of the EDGE domain, (e, 3); None where there is no such attribute."""
    return _read(mesh, name, "EDGE", "vector", (len(mesh.edges), 3))


def read_edge_floats(mesh: bpy.types.Mesh, name: str) -> NDArray[np.float32] | None:
    """Read a FLOAT attribute of the EDGE domain, (e,); None where there is no such attribute."""
    return _read(mesh, name, "EDGE", "value", (len(mesh.edges),))


def _read(mesh: bpy.types.Mesh, name: str, domain: str, item: str, shape: tuple) -> NDArray[np.float32] | None:
    attribute = mesh.attributes.get(name)
    if attribute is None or attribute.domain != domain or len(attribute.data) != shape[0]:
        return None
    values = np.empty(shape, np.float32)
    attribute.data.foreach_get(item, values.reshape(-1))
    return values


class ActiveNames(NamedTuple):
    """Names of a mesh's active attribute, active colour and colour to render; empty where there is none."""

    attribute: str
    colour: str
    render_colour: str


def active_names(mesh: bpy.types.Mesh) -> ActiveNames:
    """Return which attributes of a mesh are active; adding and removing attributes can change that."""
    active, colours = mesh.attributes.active, mesh.color_attributes
    return ActiveNames(active.name if active else "", colours.active_color_name, colours.default_color_name)


def restore_active(mesh: bpy.types.Mesh, names: ActiveNames) -> None:
    """Make the attributes active again that `active_names` found."""
    mesh.attributes.active = mesh.attributes.get(names.attribute)
    mesh.color_attributes.active_color_name = names.colour
    mesh.color_attributes.default_color_name = names.render_colour


def make_colour_active(mesh: bpy.types.Mesh, name: str) -> None:
    """Make a colour attribute the one that the viewport shows and that is rendered."""
    mesh.color_attributes.active_color_name = name
    mesh.color_attributes.default_color_name = name


def _attribute(mesh: bpy.types.Mesh, name: str, data_type: str, domain: str) -> bpy.types.Attribute:
    attribute = mesh.attributes.get(name)
    if attribute is not None and (attribute.data_type, attribute.domain) != (data_type, domain):
        mesh.attributes.remove(attribute)
        attribute = None
    return attribute or mesh.attributes.new(name, data_type, domain)
