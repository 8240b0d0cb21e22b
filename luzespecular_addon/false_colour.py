"""False colours in renders: a node group that colours by the shown values, and what a scene needs to render it.

EEVEE and Cycles show what the viewport shows. The user's materials stay as they are: the view layers override them
while *In Renders* is on (EEVEE before Blender 5.0 knows no override: there the fine faces, work planes and legend alone
have the colours). All that was switched is remembered, and switched back.
"""

from __future__ import annotations

import math

import bpy
import numpy as np

from . import colours, render_legend, results_object, work_planes, writeback

NAME = "LuzEspecular False Colour"

WITHOUT_OVERRIDE = "BLENDER_EEVEE_NEXT"
"""The render engine that overrides no materials: EEVEE as it is called before Blender 5.0."""

_STOPS = 32  # as many as Blender's colour ramp holds
_LEAST = 1e-6
"""What a computed 0 is written as: a mesh without the attribute reads 0 in shaders."""

_NOT_COMPUTED = -1.0
_PLAIN_GREY = 0.18


def shader_values(values: np.ndarray) -> np.ndarray:
    """Return values as shaders can tell them apart: above 0 where computed, -1 where not; without attribute it is 0."""
    return np.where(np.isnan(values), _NOT_COMPUTED, np.maximum(values, _LEAST))


def apply(scene: bpy.types.Scene, scale: colours.ColourScale) -> None:
    """Have renders show the false colours, or what they showed before, as the settings say."""
    settings, results = scene.luzespecular.display, scene.luzespecular.results
    carriers = results_object.all_of(scene)
    shown = [object_ for object_ in carriers if not object_.hide_get(view_layer=scene.view_layers[0])]
    planes = work_planes.all_of(scene)
    active = settings.in_renders and bool(shown or any(writeback.holds_results(mesh) for mesh in _meshes(scene)))
    for object_ in [*carriers, *planes]:
        _show_in_renders(object_, active and (object_ in shown or object_ in planes))
    hide_own = active and bool(shown)
    for object_ in scene.objects:
        _hide_from_camera(object_, hide_own and object_.luzespecular.hidden_for_results)
        if object_.type == "CAMERA":
            _focus_on_all(object_, active)
    if active:
        material = results.false_colour or _new_material(results)
        _override(scene, material)
        update(scene, scale)
    else:
        _restore(scene)


def update(scene: bpy.types.Scene, scale: colours.ColourScale) -> None:
    """Bring node group and legend in step with the viewport's."""
    material = scene.luzespecular.results.false_colour
    if material is None:
        return
    nodes = _group_of(material).nodes
    logarithmic = scale.logarithmic
    low, high = (math.log(scale.low), math.log(scale.high)) if logarithmic else (scale.low, scale.high)
    nodes["Logarithmic"].outputs[0].default_value = float(logarithmic)
    nodes["Low"].outputs[0].default_value = low
    nodes["High"].outputs[0].default_value = high
    elements = nodes["Scale"].color_ramp.elements
    rgb = colours.srgb_to_linear(colours.scale_colours(scale.name, np.linspace(0.0, 1.0, _STOPS)))
    for element, colour in zip(elements, rgb, strict=True):
        element.color = (*colour, 1.0)
    render_legend.update(scene, scale, scene.luzespecular.display.legend_in_renders)
    for mesh in _bare_meshes(scene):
        if not mesh.materials:
            mesh.materials.append(material)


def _bare_meshes(scene: bpy.types.Scene) -> list[bpy.types.Mesh]:
    """Return what carries the material itself, for engines that override none: our own meshes and work planes."""
    found = [*results_object.all_of(scene), *work_planes.all_of(scene), render_legend.find(scene)]
    return [object_.data for object_ in found if object_ is not None]


def _meshes(scene: bpy.types.Scene):
    return (object_.data for object_ in scene.objects if object_.type == "MESH")


def _show_in_renders(object_: bpy.types.Object, shown: bool) -> None:
    settings = object_.luzespecular
    if shown and object_.hide_render:
        object_.hide_render, settings.in_renders_for_results = False, True
    elif not shown and settings.in_renders_for_results:
        object_.hide_render = True
        settings.property_unset("in_renders_for_results")


def _hide_from_camera(object_: bpy.types.Object, hidden: bool) -> None:
    settings = object_.luzespecular
    if hidden and object_.visible_camera:
        object_.visible_camera, settings.off_camera_for_results = False, True
    elif not hidden and settings.off_camera_for_results:
        object_.visible_camera = True
        settings.property_unset("off_camera_for_results")


def _focus_on_all(camera: bpy.types.Object, focused: bool) -> None:
    """Have a camera see everything sharply, the legend before it too: blurred colours would be others."""
    settings, depth = camera.luzespecular, camera.data.dof
    if focused and depth.use_dof:
        depth.use_dof, settings.focused_for_results = False, True
    elif not focused and settings.focused_for_results:
        depth.use_dof = True
        settings.property_unset("focused_for_results")


def _override(scene: bpy.types.Scene, material: bpy.types.Material) -> None:
    results, view = scene.luzespecular.results, scene.view_settings
    if not results.renders:
        results.renders = True
        results.view_transform_before, results.look_before = view.view_transform, view.look
        results.exposure_before, results.gamma_before = view.exposure, view.gamma
        for view_layer in scene.view_layers:
            entry = results.overrides.add()
            entry.name, entry.material = view_layer.name, view_layer.material_override
    for view_layer in scene.view_layers:
        view_layer.material_override = material
    # Colours of the legend: no tone mapping.
    view.view_transform, view.look, view.exposure, view.gamma = "Standard", "None", 0.0, 1.0


def _restore(scene: bpy.types.Scene) -> None:
    results, view = scene.luzespecular.results, scene.view_settings
    if not results.renders:
        return
    before = {entry.name: entry.material for entry in results.overrides}
    for view_layer in scene.view_layers:
        view_layer.material_override = before.get(view_layer.name)
    view.view_transform, view.look = results.view_transform_before, results.look_before
    view.exposure, view.gamma = results.exposure_before, results.gamma_before
    material = results.false_colour
    for mesh in _bare_meshes(scene):
        if material is not None and list(mesh.materials) == [material]:
            mesh.materials.clear()
    render_legend.remove(scene)
    results.overrides.clear()
    for name in ("renders", "false_colour"):
        results.property_unset(name)
    if material is not None:
        group = _group_of(material)
        bpy.data.materials.remove(material)
        if group.users == 0:
            bpy.data.node_groups.remove(group)


def _group_of(material: bpy.types.Material) -> bpy.types.NodeTree:
    return material.node_tree.nodes["False Colour"].node_tree


def _new_material(results: bpy.types.PropertyGroup) -> bpy.types.Material:
    """Make the material: the group's colour as light that faces give off, and nothing on backs, as in the viewport."""
    material = bpy.data.materials.new(NAME)
    if material.node_tree is None:  # before Blender 5.0 a new material has no shader yet
        material.use_nodes = True
    results.false_colour = material
    tree = material.node_tree
    tree.nodes.clear()
    group = _node(tree, "ShaderNodeGroup", "False Colour", -200, 0)
    group.node_tree = _new_group()
    emission = _node(tree, "ShaderNodeEmission", "Emission", 0, 0)
    clear = _node(tree, "ShaderNodeBsdfTransparent", "Clear", 0, -120)
    geometry = _node(tree, "ShaderNodeNewGeometry", "Geometry", -200, 300)
    mix = _node(tree, "ShaderNodeMixShader", "Mix", 200, 0)
    output = _node(tree, "ShaderNodeOutputMaterial", "Output", 400, 0)
    tree.links.new(group.outputs["Color"], emission.inputs["Color"])
    tree.links.new(geometry.outputs["Backfacing"], mix.inputs[0])
    tree.links.new(emission.outputs[0], mix.inputs[1])
    tree.links.new(clear.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    return material


def _new_group() -> bpy.types.NodeTree:
    """Make the node group: shown value -> place on the scale -> colour; grey where nothing was computed."""
    tree = bpy.data.node_groups.new(NAME, "ShaderNodeTree")
    for name, kind in (("Color", "NodeSocketColor"), ("Value", "NodeSocketFloat"), ("Computed", "NodeSocketFloat")):
        tree.interface.new_socket(name, in_out="OUTPUT", socket_type=kind)
    links = tree.links
    shown = _node(tree, "ShaderNodeAttribute", "Shown", -1200, 0)
    shown.attribute_name = writeback.SHOWN
    low = _node(tree, "ShaderNodeValue", "Low", -1200, -200)
    high = _node(tree, "ShaderNodeValue", "High", -1200, -300)
    logarithmic = _node(tree, "ShaderNodeValue", "Logarithmic", -1200, 200)
    value = shown.outputs["Fac"]
    computed = _math(tree, "GREATER_THAN", value, 0.5 * _LEAST, -800, 300)
    positive = _math(tree, "MAXIMUM", value, _LEAST, -1000, 100)
    log = _math(tree, "LOGARITHM", positive, math.e, -800, 100)
    # value + logarithmic · (log - value)
    bent = _math(tree, "MULTIPLY", _math(tree, "SUBTRACT", log, value, -600, 100), logarithmic.outputs[0], -400, 100)
    placed = _math(tree, "ADD", value, bent, -200, 100)
    above = _math(tree, "SUBTRACT", placed, low.outputs[0], 0, 0)
    span = _math(tree, "SUBTRACT", high.outputs[0], low.outputs[0], 0, -200)
    position = _math(tree, "DIVIDE", above, span, 200, 0)
    ramp = _node(tree, "ShaderNodeValToRGB", "Scale", 400, 0)
    elements = ramp.color_ramp.elements
    for stop in range(1, _STOPS - 1):
        elements.new(stop / (_STOPS - 1))
    facing = _node(tree, "ShaderNodeLayerWeight", "Facing", 200, 400)
    shade = _math(tree, "MULTIPLY_ADD", facing.outputs["Facing"], -0.7 * _PLAIN_GREY, 400, 400, _PLAIN_GREY)
    grey = _node(tree, "ShaderNodeCombineColor", "Grey", 600, 400)
    for channel in grey.inputs:
        links.new(shade, channel)
    links.new(position, ramp.inputs[0])
    colour = _mix(tree, "Colour or Grey", computed, grey.outputs[0], ramp.outputs["Color"], 800, 0)
    # The legend brings colours of its own.
    legend = _node(tree, "ShaderNodeAttribute", "Legend", 800, 400)
    legend.attribute_name = render_legend.FLAG
    own = _node(tree, "ShaderNodeAttribute", "Own Colour", 800, 200)
    own.attribute_name = writeback.COLOURS
    result = _mix(tree, "Colour or Legend", legend.outputs["Fac"], colour, own.outputs["Color"], 1000, 0)
    output = _node(tree, "NodeGroupOutput", "Output", 1200, 0)
    links.new(result, output.inputs["Color"])
    links.new(value, output.inputs["Value"])
    links.new(computed, output.inputs["Computed"])
    return tree


def _node(tree: bpy.types.NodeTree, kind: str, name: str, x: float, y: float) -> bpy.types.Node:
    node = tree.nodes.new(kind)
    node.name = node.label = name
    node.location = (x, y)
    return node


def _mix(tree: bpy.types.NodeTree, name: str, share, first, second, x: float, y: float) -> bpy.types.NodeSocket:
    """Add a Mix node for colours; inputs are sockets."""
    node = _node(tree, "ShaderNodeMix", name, x, y)
    node.data_type = "RGBA"
    inputs = [socket for socket in node.inputs if socket.type == "RGBA"]
    for source, socket in zip((share, first, second), (node.inputs[0], *inputs), strict=True):
        tree.links.new(source, socket)
    return next(socket for socket in node.outputs if socket.type == "RGBA")


def _math(tree: bpy.types.NodeTree, operation: str, first, second, x: float, y: float, third: float = 0.0):
    """Add a Math node; inputs are sockets or numbers."""
    node = tree.nodes.new("ShaderNodeMath")
    node.operation, node.location = operation, (x, y)
    for socket, source in zip(node.inputs, (first, second, third), strict=True):
        if isinstance(source, bpy.types.NodeSocket):
            tree.links.new(source, socket)
        else:
            socket.default_value = source
    return node.outputs[0]
