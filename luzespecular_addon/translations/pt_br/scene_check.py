"""The scene check."""

from __future__ import annotations

OPERATORS = {
    "Check Scene": "Verificar cena",
    "Select": "Selecionar",
}

TEXTS = {
    "Scene Check": "Verificação da cena",
    "What is wrong or odd in the scene, before it is solved": (
        "O que há de errado ou estranho na cena, antes do cálculo"
    ),
    "Look for what is wrong or odd, without solving: inverted normals, gaps, overlaps, units, materials and more": (
        "Procurar o que há de errado ou estranho, sem calcular: normais invertidas, frestas, sobreposições, unidades, "
        "materiais e mais"
    ),
    "Select the objects concerned; where single faces are meant, select them in Edit Mode (Numpad . shows them)": (
        "Selecionar os objetos em questão; se são faces isoladas, selecioná-las no modo de edição "
        "(. do teclado numérico as mostra)"
    ),
    "Finding": "Item",
    "Its place in the list, from 0": "Seu lugar na lista, a partir de 0",
    "Nothing found": "Nada encontrado",
    "LuzEspecular: checking the scene (Esc cancels)": "LuzEspecular: verificando a cena (Esc cancela)",
    "Scene checked: {errors} errors, {warnings} warnings": "Cena verificada: {errors} erros, {warnings} avisos",
    "It concerns the scene as a whole: there is nothing to select": (
        "Diz respeito à cena toda: não há o que selecionar"
    ),
    "Object '{name}' cannot be selected: it is gone or hidden": (
        "O objeto '{name}' não pode ser selecionado: não existe mais ou está oculto"
    ),
}
