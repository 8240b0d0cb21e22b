"""Solving, its progress, what it says."""

from __future__ import annotations

OPERATORS = {
    "Save Picture": "Salvar imagem",
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
    "LuzEspecular: solved; leave Edit Mode (Tab) to see the results": (
        "LuzEspecular: calculado; saia do modo de edição (Tab) para ver os resultados"
    ),
    "LuzEspecular: {percent:.0f} % {stage} (Esc cancels)": "LuzEspecular: {percent:.0f} % {stage} (Esc cancela)",
    "Solve": "Calcular",
    "Live": "Ao vivo",
    "Once solved, show another hour, date or sky at once, as one drags or plays; solve again when anything else "
    "changes": (
        "Depois do cálculo, mostrar logo outra hora, data ou céu, ao arrastar ou reproduzir; se algo mais mudar, "
        "calcule de novo"
    ),
    "Solve once more to have results follow hour, date and sky": (
        "Calcule mais uma vez para que os resultados sigam hora, data e céu"
    ),
    "The scene changed since it was solved: solve again": "A cena mudou desde o cálculo: calcule de novo",
    "No calculation is running": "Nenhum cálculo em andamento",
    "Cancel": "Cancelar",
    "about {seconds:.0f} s left": "faltam cerca de {seconds:.0f} s",
    "about {minutes:.0f} min left": "faltam cerca de {minutes:.0f} min",
    "Save a picture of the results with their legend as a PNG file, seen from the scene's camera": (
        "Salvar uma imagem dos resultados com sua legenda em um arquivo PNG, vista da câmera da cena"
    ),
    "The picture could not be saved: {error}": "Não foi possível salvar a imagem: {error}",
    "Width": "Largura",
    "Height": "Altura",
    "Pixels": "Pixels",
}
