"""Photometric properties of Blender materials: our own settings, or sensible values read from the shader.

Rules for reading a shader, and no more than that:

- reflectance: luminous weight of the linear colour (ITU-R BT.709); smooth metal is a mirror, rough metal diffuse;
- transmission: a pane of the shader's index of refraction, tinted by its colour; with mixtures, a plain straight share;
- emission: exitance = π · 683 lm/W · strength · colour's weight, Blender's radiance in W/(m² sr) with 683 lm/W as in
  the glTF exchange of Blender lights;
- an input that a texture drives cannot be read: the viewport colour stands in, and the user is told.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import bpy
from bpy.app.translations import pgettext_rpt as rpt_

from .. import core as luz
from ..core.materials import normal_interface_reflectance
from . import library
from .colours import relative_luminance
from .notices import Notice
from .translations import solver_message

LUMENS_PER_WATT = 683.0
"""Luminous efficacy that Blender's exchange formats take for light of any colour [lm/W]."""

REFLECTANCE_WITHOUT_MATERIAL = 0.5

_SINGLE_PRECISION = 1e-6

MIRROR_ROUGHNESS = 0.2
"""Metal at most this rough counts as a mirror."""


@dataclass(frozen=True)
class Optics:
    """Photometric values of a material, not yet checked.

    Attributes
    ----------
    diffuse_reflectance, specular_reflectance, regular_transmittance : float
        Shares of the incident light, 0 to 1.
    exitance : float
        Emitted [lm/m²].
    refractive_index : float or None
        Of a clear pane.
    remarks : tuple of str
        What could not be read and what stands in for it.
    """

    diffuse_reflectance: float = 0.0
    specular_reflectance: float = 0.0
    regular_transmittance: float = 0.0
    exitance: float = 0.0
    refractive_index: float | None = None
    remarks: tuple[str, ...] = ()

    @property
    def total(self) -> float:
        """Sum of the shares that are not absorbed, for light at normal incidence."""
        return self.diffuse_reflectance + self.specular_reflectance + self.regular_transmittance

    def material(self) -> luz.Material:
        """Return the solver's material; raises its `SceneError` where the values cannot be."""
        return luz.Material(
            diffuse_reflectance=self.diffuse_reflectance,
            specular_reflectance=self.specular_reflectance,
            regular_transmittance=self.regular_transmittance,
            exitance=self.exitance,
            refractive_index=self.refractive_index,
        )

    def shared_by_two_faces(self) -> Optics:
        """Return what each face of a solid pane carries, so that the two together pass as much as the whole pane."""
        return replace(
            self,
            regular_transmittance=math.sqrt(self.regular_transmittance),
            refractive_index=None,
        )


def read(material: bpy.types.Material | None) -> Optics:
    """Return the photometric values of a Blender material, by its own LuzEspecular settings or from its shader."""
    if material is None:
        return Optics(diffuse_reflectance=REFLECTANCE_WITHOUT_MATERIAL)
    if material.luzespecular.source == "CUSTOM":
        return _custom(material.luzespecular)
    return from_shader(material)


def _custom(settings: bpy.types.PropertyGroup) -> Optics:
    transmittance, exitance = as_typed(settings.regular_transmittance), as_typed(settings.exitance)
    if settings.use_refractive_index:
        index = as_typed(settings.refractive_index)
        clearest = _clearest(index)
        if transmittance < clearest * (1.0 + _SINGLE_PRECISION):
            transmittance = min(transmittance, clearest)
        return Optics(regular_transmittance=transmittance, exitance=exitance, refractive_index=index)
    return Optics(
        as_typed(settings.diffuse_reflectance), as_typed(settings.specular_reflectance), transmittance, exitance
    )


def write(settings: bpy.types.PropertyGroup, optics: Optics) -> None:
    """Give a material's settings the values as its own."""
    settings.source = "CUSTOM"
    settings.diffuse_reflectance = optics.diffuse_reflectance
    settings.specular_reflectance = optics.specular_reflectance
    settings.regular_transmittance = optics.regular_transmittance
    settings.exitance = optics.exitance
    settings.use_refractive_index = optics.refractive_index is not None
    if optics.refractive_index is not None:
        settings.refractive_index = optics.refractive_index


def of_entry(entry: library.Entry) -> Optics:
    """Return the values of a material of the library."""
    return Optics(entry.diffuse, entry.specular, entry.transmittance, refractive_index=entry.index)


def from_shader(material: bpy.types.Material) -> Optics:
    """Return the photometric values that the shader of a material stands for."""
    node = _surface_node(material)
    reader = _READERS.get(node.bl_idname) if node else None
    if reader is None:
        if node is None:
            return Optics(diffuse_reflectance=_viewport_reflectance(material))
        remark = rpt_("its shader '{node}' cannot be read; the viewport colour is used").format(node=node.name)
        return Optics(diffuse_reflectance=_viewport_reflectance(material), remarks=(remark,))
    inputs = _Inputs(material, node)
    return replace(reader(inputs), remarks=tuple(inputs.remarks))


def as_typed(value: float) -> float:
    """Return the decimal number that the user gave, since Blender keeps single precision (0.6 + 0.4 would exceed 1)."""
    return float(f"{value:.7g}")


def notices(material: bpy.types.Material, optics: Optics) -> list[Notice]:
    """Return what the user should know about the values read for a material."""
    remarks = [
        Notice("WARNING", rpt_("Material '{name}': {remark}").format(name=material.name, remark=remark))
        for remark in optics.remarks
    ]
    try:
        optics.material()
    except luz.SceneError as error:
        text = rpt_("Material '{name}': {error}. See Properties > Material > LuzEspecular")
        remarks.append(
            Notice("ERROR", text.format(name=material.name, error=solver_message(error).removeprefix("Material: ")))
        )
    return remarks


def _surface_node(material: bpy.types.Material) -> bpy.types.ShaderNode | None:
    """Return the node that is plugged into the material's surface, a lone Principled one failing that."""
    tree = material.node_tree
    if tree is None:
        return None
    output = tree.get_output_node("ALL") or tree.get_output_node("CYCLES") or tree.get_output_node("EEVEE")
    if output is None or not output.inputs["Surface"].is_linked:
        return None
    return output.inputs["Surface"].links[0].from_node


class _Inputs:
    """Values of a shader node's inputs; notes those that are driven by other nodes."""

    def __init__(self, material: bpy.types.Material, node: bpy.types.ShaderNode):
        self._material, self._node = material, node
        self.remarks: list[str] = []

    def number(self, name: str, otherwise: float) -> float:
        socket = self._node.inputs.get(name)
        if socket is None:
            return otherwise
        if socket.is_linked:
            remark = rpt_("its input '{name}' comes from other nodes; {value:g} is used")
            self.remarks.append(remark.format(name=name, value=otherwise))
            return otherwise
        return as_typed(socket.default_value)

    def colour(self, name: str) -> float:
        """Return the luminous weight of a colour, 0 to 1 for reflectances."""
        socket = self._node.inputs[name]
        if socket.is_linked:
            remark = rpt_("its input '{name}' comes from other nodes; the viewport colour is used")
            self.remarks.append(remark.format(name=name))
            return _viewport_reflectance(self._material)
        return as_typed(float(relative_luminance(socket.default_value)))


def _viewport_reflectance(material: bpy.types.Material) -> float:
    return min(as_typed(float(relative_luminance(material.diffuse_color))), 1.0)


def _principled(inputs: _Inputs) -> Optics:
    colour = min(inputs.colour("Base Color"), 1.0)
    opaque = min(inputs.number("Alpha", 1.0), 1.0)
    metallic = min(inputs.number("Metallic", 0.0), 1.0)
    passing = min(inputs.number("Transmission Weight", 0.0), 1.0) * (1.0 - metallic)
    mirror = metallic if inputs.number("Roughness", 0.5) <= MIRROR_ROUGHNESS else 0.0
    strength = inputs.number("Emission Strength", 0.0)
    exitance = _exitance(inputs.colour("Emission Color"), strength) if strength > 0.0 else 0.0
    if passing >= 1.0 and opaque >= 1.0:
        return replace(_pane(colour, inputs.number("IOR", 1.5)), exitance=exitance)
    return Optics(
        diffuse_reflectance=opaque * colour * (1.0 - mirror - passing),
        specular_reflectance=opaque * colour * mirror,
        regular_transmittance=opaque * colour * passing + (1.0 - opaque),
        exitance=exitance,
    )


def _pane(colour: float, index: float) -> Optics:
    if index <= 1.0:
        return Optics(regular_transmittance=colour)
    return Optics(regular_transmittance=colour * _clearest(index), refractive_index=index)


def _clearest(index: float) -> float:
    """Return what a pane that absorbs nothing transmits at normal incidence, the inner reflections included."""
    interface = normal_interface_reflectance(index)
    return (1.0 - interface) / (1.0 + interface)


def _exitance(colour: float, strength: float) -> float:
    return math.pi * LUMENS_PER_WATT * strength * colour


def _glass(inputs: _Inputs) -> Optics:
    return _pane(min(inputs.colour("Color"), 1.0), inputs.number("IOR", 1.5))


def _glossy(inputs: _Inputs) -> Optics:
    colour = min(inputs.colour("Color"), 1.0)
    if inputs.number("Roughness", 0.5) <= MIRROR_ROUGHNESS:
        return Optics(specular_reflectance=colour)
    return Optics(diffuse_reflectance=colour)


_READERS = {
    "ShaderNodeBsdfPrincipled": _principled,
    "ShaderNodeBsdfDiffuse": lambda inputs: Optics(diffuse_reflectance=min(inputs.colour("Color"), 1.0)),
    "ShaderNodeBsdfGlossy": _glossy,
    "ShaderNodeBsdfAnisotropic": _glossy,
    "ShaderNodeBsdfGlass": _glass,
    "ShaderNodeBsdfTransparent": lambda inputs: Optics(regular_transmittance=min(inputs.colour("Color"), 1.0)),
    "ShaderNodeEmission": lambda inputs: Optics(
        exitance=_exitance(inputs.colour("Color"), inputs.number("Strength", 1.0))
    ),
}
