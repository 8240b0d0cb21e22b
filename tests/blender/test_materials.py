"""Photometric values of Blender materials: our own settings, and what a shader stands for."""

import math

import pytest

WHITE = (1.0, 1.0, 1.0, 1.0)


@pytest.fixture
def shader(bpy):
    """Makes a material of one shader node with the given inputs; returns material and node."""

    def make(kind="ShaderNodeBsdfPrincipled", **inputs):
        material = bpy.data.materials.new("Material")
        if material.node_tree is None:
            material.use_nodes = True
        nodes, links = material.node_tree.nodes, material.node_tree.links
        nodes.clear()
        node, output = nodes.new(kind), nodes.new("ShaderNodeOutputMaterial")
        links.new(node.outputs[0], output.inputs["Surface"])
        for name, value in inputs.items():
            node.inputs[name.replace("_", " ")].default_value = value
        return material, node

    return make


def test_new_material_reflects_its_base_colour(addon, shader):
    material, _ = shader()
    optics = addon.materials.read(material)
    assert optics.diffuse_reflectance == pytest.approx(0.8)
    assert (optics.specular_reflectance, optics.regular_transmittance, optics.exitance) == (0, 0, 0)
    assert not optics.remarks


@pytest.mark.parametrize(("channel", "weight"), [(0, 0.2126), (1, 0.7152), (2, 0.0722)])
def test_colours_weigh_as_the_eye_sees(addon, shader, channel, weight):
    colour = [0.0, 0.0, 0.0, 1.0]
    colour[channel] = 1.0
    material, _ = shader(Base_Color=colour)
    assert addon.materials.read(material).diffuse_reflectance == pytest.approx(weight, abs=1e-6)


def test_smooth_metal_is_a_mirror_and_rough_metal_diffuse(addon, shader):
    smooth, _ = shader(Base_Color=(0.9, 0.9, 0.9, 1.0), Metallic=1.0, Roughness=0.05)
    rough, _ = shader(Base_Color=(0.9, 0.9, 0.9, 1.0), Metallic=1.0, Roughness=0.6)
    assert addon.materials.read(smooth).specular_reflectance == pytest.approx(0.9)
    assert addon.materials.read(smooth).diffuse_reflectance == 0.0
    assert addon.materials.read(rough).specular_reflectance == 0.0
    assert addon.materials.read(rough).diffuse_reflectance == pytest.approx(0.9)


def test_half_metal_shares(addon, shader):
    material, _ = shader(Base_Color=(0.8, 0.8, 0.8, 1.0), Metallic=0.25, Roughness=0.0)
    optics = addon.materials.read(material)
    assert optics.diffuse_reflectance == pytest.approx(0.6)
    assert optics.specular_reflectance == pytest.approx(0.2)


@pytest.mark.parametrize("kind", ["ShaderNodeBsdfPrincipled", "ShaderNodeBsdfGlass"])
def test_glass_is_a_pane(addon, shader, kind):
    inputs = {"Transmission_Weight": 1.0, "Base_Color": WHITE} if kind.endswith("Principled") else {"Color": WHITE}
    material, _ = shader(kind, IOR=1.52, **inputs)
    optics = addon.materials.read(material)
    interface = (0.52 / 2.52) ** 2
    assert optics.refractive_index == 1.52
    assert optics.regular_transmittance == pytest.approx((1 - interface) / (1 + interface), rel=1e-6)
    assert optics.diffuse_reflectance == optics.specular_reflectance == 0.0
    optics.material()  # the solver takes it


def test_tinted_glass_passes_less(addon, shader):
    clear, _ = shader("ShaderNodeBsdfGlass", Color=WHITE, IOR=1.5)
    tinted, _ = shader("ShaderNodeBsdfGlass", Color=(0.5, 0.5, 0.5, 1.0), IOR=1.5)
    ratio = addon.materials.read(tinted).regular_transmittance / addon.materials.read(clear).regular_transmittance
    assert ratio == pytest.approx(0.5)


def test_cut_out_by_alpha_lets_light_straight_through(addon, shader):
    material, _ = shader(Base_Color=(0.5, 0.5, 0.5, 1.0), Alpha=0.25)
    optics = addon.materials.read(material)
    assert optics.regular_transmittance == pytest.approx(0.75)
    assert optics.diffuse_reflectance == pytest.approx(0.125)


def test_emission_is_exitance(addon, shader):
    white = shader(Emission_Color=WHITE, Emission_Strength=2.0)[0]
    green = shader("ShaderNodeEmission", Color=(0.0, 1.0, 0.0, 1.0), Strength=2.0)[0]
    assert addon.materials.read(white).exitance == pytest.approx(math.pi * 683 * 2)
    assert addon.materials.read(green).exitance == pytest.approx(math.pi * 683 * 2 * 0.7152)
    assert addon.materials.read(green).diffuse_reflectance == 0.0


@pytest.mark.parametrize(
    ("kind", "inputs", "field", "value"),
    [
        ("ShaderNodeBsdfDiffuse", {"Color": (0.3, 0.3, 0.3, 1.0)}, "diffuse_reflectance", 0.3),
        ("ShaderNodeBsdfTransparent", {"Color": (0.3, 0.3, 0.3, 1.0)}, "regular_transmittance", 0.3),
        ("ShaderNodeBsdfAnisotropic", {"Color": (0.3, 0.3, 0.3, 1.0), "Roughness": 0.0}, "specular_reflectance", 0.3),
        ("ShaderNodeBsdfAnisotropic", {"Color": (0.3, 0.3, 0.3, 1.0), "Roughness": 0.9}, "diffuse_reflectance", 0.3),
    ],
)
def test_simple_shaders(addon, shader, kind, inputs, field, value):
    optics = addon.materials.read(shader(kind, **inputs)[0])
    assert getattr(optics, field) == pytest.approx(value)
    assert optics.total == pytest.approx(value)


def test_texture_is_replaced_by_the_viewport_colour_and_said_so(addon, shader):
    material, node = shader()
    image = material.node_tree.nodes.new("ShaderNodeTexImage")
    material.node_tree.links.new(image.outputs["Color"], node.inputs["Base Color"])
    material.diffuse_color = (0.2, 0.2, 0.2, 1.0)
    optics = addon.materials.read(material)
    assert optics.diffuse_reflectance == pytest.approx(0.2)
    notice = addon.materials.notices(material, optics)[0]
    assert notice.level == "WARNING"
    assert "'Material'" in notice.text
    assert "'Base Color'" in notice.text


def test_shader_that_cannot_be_read_is_named(addon, shader):
    material, _ = shader("ShaderNodeBsdfToon")
    material.diffuse_color = (0.4, 0.4, 0.4, 1.0)
    optics = addon.materials.read(material)
    assert optics.diffuse_reflectance == pytest.approx(0.4)
    assert len(optics.remarks) == 1


def test_material_without_nodes_has_its_viewport_colour(addon, bpy):
    material = bpy.data.materials.new("Plain")
    if material.node_tree is not None:
        material.node_tree.nodes.clear()
    material.diffuse_color = (0.6, 0.6, 0.6, 1.0)
    optics = addon.materials.read(material)
    assert optics.diffuse_reflectance == pytest.approx(0.6)
    assert not optics.remarks


def test_no_material_is_half_reflecting(addon):
    assert addon.materials.read(None).diffuse_reflectance == 0.5


def test_own_values_win_over_the_shader(addon, shader):
    material, _ = shader()
    settings = material.luzespecular
    settings.source, settings.diffuse_reflectance, settings.specular_reflectance = "CUSTOM", 0.1, 0.2
    optics = addon.materials.read(material)
    assert (optics.diffuse_reflectance, optics.specular_reflectance) == (0.1, 0.2)


def test_single_precision_does_not_make_shares_exceed_one(addon, make):
    material = make.material(diffuse_reflectance=0.6, specular_reflectance=0.4)
    addon.materials.read(material).material()
    assert not addon.materials.notices(material, addon.materials.read(material))


def test_impossible_pane_is_an_error_that_names_the_material(addon, make):
    material = make.material("Vidraça", use_refractive_index=True, refractive_index=1.52, regular_transmittance=0.99)
    (notice,) = addon.materials.notices(material, addon.materials.read(material))
    assert notice.level == "ERROR"
    assert "Vidraça" in notice.text


@pytest.mark.parametrize("index", [1.1, 1.33, 1.45, 1.5, 1.52, 1.6, 1.77, 2.4])
def test_shader_values_can_be_copied(addon, bpy, shader, index):
    material, _ = shader("ShaderNodeBsdfGlass", Color=WHITE, IOR=index)
    before = addon.materials.read(material)
    with bpy.context.temp_override(material=material):
        bpy.ops.luzespecular.values_from_shader()
    after = addon.materials.read(material)
    assert material.luzespecular.source == "CUSTOM"
    assert after.refractive_index == before.refractive_index
    assert after.regular_transmittance == pytest.approx(before.regular_transmittance, rel=1e-6)
    after.material()


def test_library_is_possible_and_has_sources(addon):
    library = addon.library
    assert len({entry.key for entry in library.LIBRARY}) == len(library.LIBRARY) > 30
    for entry in library.LIBRARY:
        assert entry.source in library.SOURCES, entry
        assert entry.stated, entry
        material = addon.materials.of_entry(entry).material()  # raises where it cannot be
        assert 0 < material.diffuse_reflectance + material.specular_reflectance + material.regular_transmittance <= 1
    assert sum(len(entries) for entries in library.groups().values()) == len(library.LIBRARY)


def test_values_are_within_what_the_source_states(addon):
    for entry in addon.library.LIBRARY:
        low, high = _range(entry.stated)
        assert low <= entry.diffuse + entry.specular + entry.transmittance <= high, entry


def _range(stated):
    ends = [float(part) for part in stated.removesuffix("%").split("–")]
    return [end / 100 if "%" in stated else end for end in (ends[0], ends[-1])]


def test_library_fills_the_active_material(addon, bpy, make):
    paint = bpy.data.materials.new("Tinta")
    square = make.square(material=paint)
    bpy.context.view_layer.objects.active = square
    assert bpy.ops.luzespecular.apply_material(material="MIRROR") == {"FINISHED"}
    optics = addon.materials.read(paint)
    assert (optics.diffuse_reflectance, optics.specular_reflectance) == (0.0, pytest.approx(0.84))
    assert "GharPedia" in paint.luzespecular.reference
    bpy.ops.luzespecular.apply_material(material="GLASS_4")
    optics = addon.materials.read(paint)
    assert (optics.regular_transmittance, optics.refractive_index) == pytest.approx((0.89, 1.52))
    with pytest.raises(RuntimeError, match="no material 'GOLD'"):
        bpy.ops.luzespecular.apply_material(material="GOLD")


def test_buttons_need_a_material(bpy, make):
    bpy.context.view_layer.objects.active = make.square()
    with pytest.raises(RuntimeError, match="add one to the object"):
        bpy.ops.luzespecular.apply_material(material="MIRROR")
