"""Solving, its progress, what it says."""

from __future__ import annotations

OPERATORS = {
    "Cancel": "Cancelar",
    "Solve": "Calcular",
}

TEXTS = {
    "LuzEspecular": "LuzEspecular",
    "Solve, progress and cancel": "Calcular, andamento e cancelar",
    "no material": "sem material",
    "Calculate the daylight of the scene and show it in false colours": (
        "Calcular a luz natural da cena e mostrá-la em cores falsas"
    ),
    "Stop the calculation; nothing is changed": "Parar o cálculo; nada é alterado",
    "A calculation is running: wait for it, or cancel it": "Há um cálculo em andamento: espere por ele ou cancele-o",
    "Leave Edit Mode first (Tab)": "Saia antes do modo de edição (Tab)",
    "Cancelled; nothing was changed": "Cancelado; nada foi alterado",
    "Solved: {title}; {count} faces": "Calculado: {title}; {count} faces",
    "LuzEspecular: {percent:.0f} % {stage} (Esc cancels)": "LuzEspecular: {percent:.0f} % {stage} (Esc cancela)",
}
