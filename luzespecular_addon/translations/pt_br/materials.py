"""Photometric values of materials."""

from __future__ import annotations

OPERATORS = {
    "Apply Material": "Aplicar material",
    "Add Material Preset": "Adicionar predefinição de material",
    "Copy from Shader": "Copiar do sombreador",
}

TEXTS = {
    "Photometric values of the active material": "Valores fotométricos do material ativo",
    "Black: absorbs all light": "Preto: absorve toda a luz",
    "Values": "Valores",
    "Where the photometric values come from": "De onde vêm os valores fotométricos",
    "From Shader": "Do sombreador",
    "Read the values from the material's shader nodes": "Ler os valores dos nós de sombreador do material",
    "Custom": "Personalizados",
    "Use the values given here": "Usar os valores informados aqui",
    "Diffuse Reflectance": "Refletância difusa",
    "Share of the light that leaves evenly in all directions": "Parcela da luz que sai por igual em todas as direções",
    "Specular Reflectance": "Refletância especular",
    "Share of the light that leaves as from a mirror": "Parcela da luz que sai como de um espelho",
    "Regular Transmittance": "Transmitância regular",
    "Share of the light that passes straight through the whole pane at normal incidence": (
        "Parcela da luz que atravessa em linha reta a lâmina inteira em incidência normal"
    ),
    "Clear Pane": "Vidro transparente",
    "Let reflection and transmission follow from the refractive index and the angle of incidence": (
        "Deduzir reflexão e transmissão do índice de refração e do ângulo de incidência"
    ),
    "Refractive Index": "Índice de refração",
    "Of the pane; window glass has 1.52": "Da lâmina; o vidro de janela tem 1,52",
    "Exitance (lm/m²)": "Exitância (lm/m²)",
    "Luminous exitance that the surface emits by itself": "Exitância luminosa que a própria superfície emite",
    "Copy the values that the shader stands for, to change them by hand": (
        "Copiar os valores que o sombreador representa, para alterá-los à mão"
    ),
    "Reference": "Referência",
    "Where the values come from: a measurement, a data sheet, a library": (
        "De onde vêm os valores: uma medição, uma ficha técnica, uma biblioteca"
    ),
    "Library": "Biblioteca",
    "Common building materials with their values and sources": (
        "Materiais de construção comuns com seus valores e fontes"
    ),
    "Materials": "Materiais",
    "Materials saved by the user": "Materiais salvos pelo usuário",
    "Save or remove a preset: the photometric values of a material": (
        "Salvar ou remover uma predefinição: os valores fotométricos de um material"
    ),
    "Give the active material the photometric values of a common building material": (
        "Dar ao material ativo os valores fotométricos de um material de construção comum"
    ),
    "Material": "Material",
    "Key of the material in the library": "Chave do material na biblioteca",
    "{stated}. Source: {source}": "{stated}. Fonte: {source}",
    "There is no material '{key}' in the library: choose one of {known}": (
        "Não há o material '{key}' na biblioteca: escolha um destes: {known}"
    ),
    "There is no material: add one to the object first": "Não há material: adicione antes um ao objeto",
    "The material is linked from another file: make it local first": (
        "O material vem de outro arquivo: torne-o local antes"
    ),
}
