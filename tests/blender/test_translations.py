"""Every text of the interface has its Brazilian Portuguese; the texts are found in the source, not in a list."""

import ast
import re
import string
from pathlib import Path

import pytest
from planted_faults import FAULTS

import luzespecular

ADDON = Path(__file__).resolve().parents[2] / "luzespecular_addon"
TEXT_KEYWORDS = {"name", "description", "text"}
TRANSLATING_CALLS = {"data_", "iface_", "rpt_", "poll_message_set"}
PROPERTY_CALLS = {
    "BoolProperty",
    "CollectionProperty",
    "EnumProperty",
    "FloatProperty",
    "IntProperty",
    "PointerProperty",
    "ShareProperty",
    "StringProperty",
}


def _literal(node):
    """The text of a string literal, written in one piece or several; None for anything else."""
    try:
        value = ast.literal_eval(node)
    except ValueError:
        return None
    return value if isinstance(value, str) and any(letter.isalpha() for letter in value) else None


def _called(node):
    function = node.func
    return function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")


def _enum_items(tree):
    """Names and descriptions of all (identifier, name, description) tuples."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Tuple) and len(node.elts) == 3 and all(_literal(e) or _is_digit(e) for e in node.elts):
            identifier = ast.literal_eval(node.elts[0])
            if identifier.replace("_", "").isalnum() and " " not in identifier and _literal(node.elts[2]):
                yield from (_literal(element) for element in node.elts[1:])


def _library_names(tree):
    """Names and groups of the library's materials."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and _called(node) == "Entry":
            yield from (_literal(argument) for argument in node.args[1:3])


def _is_digit(node):
    return isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.isdigit()


def interface_texts():
    """(context, text) of every text that the user can see."""
    texts = set()
    for path in sorted(ADDON.rglob("*.py")):
        if path.parent.name == "pt_br" or path.name == "__main__.py":
            continue
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            if isinstance(node, ast.Call):
                name = _called(node)
                if name in TRANSLATING_CALLS and node.args and _literal(node.args[0]):
                    texts.add(("*", _literal(node.args[0])))
                visible = name in PROPERTY_CALLS or name in {"label", "operator", "prop"}
                for keyword in node.keywords if visible else ():
                    if keyword.arg in TEXT_KEYWORDS and _literal(keyword.value):
                        texts.add(("*", _literal(keyword.value)))
            if isinstance(node, ast.ClassDef):
                operator = "_OT_" in node.name
                for statement in node.body:
                    targets = [t.id for t in getattr(statement, "targets", []) if isinstance(t, ast.Name)]
                    if "bl_description" in targets:
                        texts.add(("*", _literal(statement.value)))
                    if "bl_label" in targets:
                        texts.add(("Operator" if operator else "*", _literal(statement.value)))
        if path.name == "library.py":
            texts.update(("*", text) for text in _library_names(tree))
        if path.name == "choices.py" or path.parent.name == "properties":
            texts.update(("*", text) for text in _enum_items(tree))
    return texts


def test_texts_are_found():
    texts = interface_texts()
    assert len(texts) > 150
    for expected in (
        ("Operator", "Solve"),
        ("*", "Site & Time"),
        ("*", "North Offset"),
        ("*", "1 Overcast, steep gradation"),
        ("*", "Leave Edit Mode first (Tab)"),
        ("*", "No results yet"),
    ):
        assert expected in texts


def test_every_text_is_translated(addon):
    table = addon.translations.table()["pt_BR"]
    missing = sorted(interface_texts() - set(table))
    assert not missing, "\n".join(f"{context}: {text}" for context, text in missing)


def test_nothing_is_translated_that_nobody_sees(addon):
    seen = {text for _, text in interface_texts()}
    for said in ("STAGES", "KINDS", "SOLVER"):  # by the solver
        seen |= set(getattr(addon.translations, said))
    assert not [text for _, text in addon.translations.table()["pt_BR"] if text not in seen]


def solver_messages():
    """Messages of the errors that the solver raises and of what it notes, with {} for what is filled in."""
    for path in sorted((ADDON.parent / "core").glob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and _called(node) in ("SceneError", "Cancelled", "append") and node.args:
                parts = node.args[0].values if isinstance(node.args[0], ast.JoinedStr) else [node.args[0]]
                yield "".join(part.value if isinstance(part, ast.Constant) else "{}" for part in parts)
    for room in ("flaws", "inspection", "looks", "scene"):  # what the scene check finds is put together there
        for node in ast.walk(ast.parse((ADDON.parent / "core" / f"{room}.py").read_text(encoding="utf-8"))):
            if isinstance(node, ast.JoinedStr):
                said = "".join(part.value if isinstance(part, ast.Constant) else "{}" for part in node.values)
                yield from (said, f"Surface '{{}}': {said}")
            elif isinstance(node, ast.Constant) and isinstance(node.value, str):
                yield node.value


def test_the_solver_still_says_what_is_translated(addon):
    said = set(solver_messages())
    assert len(said) > 50
    unknown = [text for text in addon.translations.SAID_BY_SOLVER if re.sub(r"{\w+}", "{}", text) not in said]
    assert not unknown, "the solver's messages have changed: bring translations/pt_br/solver.py in step"


def test_messages_of_the_solver_are_translated(addon, monkeypatch):
    luz, translations = addon.luz, addon.translations
    monkeypatch.setattr(translations, "rpt_", translations.SOLVER.__getitem__)
    scene = luz.Scene()
    for refused, expected in (
        (lambda: luz.prepare(scene), "A cena não tem superfícies; adicione ao menos uma"),
        (
            lambda: luz.Material(diffuse_reflectance=0.7, regular_transmittance=0.6),
            "Material: refletância difusa + refletância especular + transmitância regular = 1.3; "
            "reduza-as a no máximo 1",
        ),
        (
            lambda: scene.add("Laje 'á'", [[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]], luz.Material()),
            "A superfície 'Laje 'á'' não é plana: um vértice está a 0.118 m do plano; "
            "mova-o, ou divida a superfície em triângulos",
        ),
        (lambda: luz.UniformSky("bright"), None),
    ):
        with pytest.raises(luz.SceneError) as caught:
            refused()
        assert translations.solver_message(caught.value) == (expected or str(caught.value))


def test_findings_of_the_scene_check_are_translated(addon, monkeypatch):
    translations = addon.translations
    monkeypatch.setattr(translations, "rpt_", translations.SOLVER.__getitem__)
    foreign = [
        said
        for fault, (make, *_) in FAULTS.items()
        if fault != "nothing"
        for finding in luzespecular.check(make())
        for said in (finding.message, finding.remedy, str(finding))
        if finding.remedy in translations.solver_message(said) or translations.solver_message(said) == said
    ]
    assert not foreign


def test_remedies_speak_of_blenders_menus(addon):
    translations = addon.translations
    (finding,) = luzespecular.check(FAULTS["all walls turned over"][0]())
    assert "Mesh > Normals > Recalculate Inside" in translations.solver_message(str(finding))
    for template, words in translations.IN_BLENDER.items():
        assert template not in translations.SOLVER
        assert words in translations.SOLVER, words
        assert re.findall(r"{\w+}", template) == re.findall(r"{\w+}", words)
        assert "max_area" not in words and "vertices)" not in words


def test_what_is_added_to_a_finding_is_translated(addon, monkeypatch):
    translations = addon.translations
    monkeypatch.setattr(translations, "rpt_", translations.SOLVER.__getitem__)
    said = (
        "Surface 'Roof' has its back to 'Sky' and its front sees nothing "
        "(of its 900 planes the 300 largest were looked at, others may be alike)"
    )
    told = translations.solver_message(said)
    assert told.endswith("não vê nada (de seus 900 planos foram vistos os 300 maiores, outros podem ser iguais)")


def test_kinds_of_findings_are_translated(addon):
    found = {finding.kind for make, *_ in FAULTS.values() for finding in luzespecular.check(make())}
    assert len(found) > 15
    assert not found - set(addon.translations.KINDS)


def test_names_of_properties_have_a_context_of_their_own(addon, bpy):
    # Blender's own translation goes before an extension's: "Clear" would read as the verb.
    context = addon.translations.CONTEXT
    assert (context, "Clear") in addon.translations.table()["pt_BR"]
    for group in ("site", "sky", "accuracy", "display"):
        rna = bpy.types.Scene.bl_rna.properties["luzespecular"].fixed_type.properties[group].fixed_type
        for name, own in rna.properties.items():
            if name not in ("rna_type", "name"):
                assert own.translation_context == context, name


def test_placeholders_agree(addon):
    for (_, english), translated in addon.translations.table()["pt_BR"].items():
        fields = [
            sorted(field for _, field, _, _ in string.Formatter().parse(text) if field is not None)
            for text in (english, translated)
        ]
        assert fields[0] == fields[1], english


def test_translation_reaches_the_interface(addon, bpy):
    view = bpy.context.preferences.view
    try:
        view.language = "pt_BR"
    except TypeError:
        pytest.skip("this Blender has no translations")
    view.use_translate_interface = True
    assert bpy.app.translations.pgettext_iface("North Offset") == "Desvio norte"
