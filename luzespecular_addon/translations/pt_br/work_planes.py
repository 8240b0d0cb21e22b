"""Work planes: grids of points in mid-air."""

from __future__ import annotations

OPERATORS = {
    "Add Work Plane": "Adicionar plano de trabalho",
    "Save Points": "Salvar pontos",
}

TEXTS = {
    "Work Planes": "Planos de trabalho",
    "Work Plane": "Plano de trabalho",
    "Work plane": "Plano de trabalho",
    "Grids of points in mid-air and what was read on them": "Malhas de pontos no ar e o que nelas se leu",
    "Read the illuminance at the middle of each face; the object blocks no light": (
        "Ler a iluminância no meio de cada face; o objeto não bloqueia luz"
    ),
    "Threshold (lx)": "Limiar (lx)",
    "Illuminance that the share of the area counts from": "Iluminância a partir da qual conta a parcela da área",
    "Lay a grid of points above the floor of the selected objects, or of all; solving then reads the light there": (
        "Dispor uma malha de pontos acima do piso dos objetos selecionados, ou de todos; o cálculo então lê a luz ali"
    ),
    "Height (m)": "Altura (m)",
    "Above the floor": "Acima do piso",
    "Spacing (m)": "Espaçamento (m)",
    "Distance of the points": "Distância entre os pontos",
    "Border (m)": "Borda (m)",
    "Strip along the walls that is left out": "Faixa junto às paredes que fica de fora",
    "The grid would have {count} points: choose a larger spacing": (
        "A malha teria {count} pontos: escolha um espaçamento maior"
    ),
    "No floor was found: select an object with faces that look up, or choose a smaller border": (
        "Nenhum piso encontrado: selecione um objeto com faces voltadas para cima, ou escolha uma borda menor"
    ),
    "{count} points; solve to read them": "{count} pontos; calcule para lê-los",
    "Save the points of all work planes and their illuminance as a CSV file": (
        "Salvar os pontos de todos os planos de trabalho e sua iluminância em um arquivo CSV"
    ),
    "No work plane has been read yet: solve first": "Nenhum plano de trabalho foi lido ainda: calcule antes",
    "Work plane '{name}' shares its mesh or is linked: use Object > Relations > Make Single User": (
        "O plano de trabalho '{name}' compartilha sua malha ou é vinculado: "
        "use Objeto > Relações > Tornar usuário único"
    ),
    "Not read yet: solve": "Ainda não lido: calcule",
    "Moved or edited since: solve again": "Movido ou editado desde então: calcule de novo",
    "Use {name}": "Usar {name}",
    "Minimum": "Mínimo",
    "Mean": "Média",
    "Maximum": "Máximo",
    "Uniformity (min/mean)": "Unif. (mín/méd)",
    "Area": "Área",
    "Mean daylight factor": "Fator médio de luz diurna",
    "{threshold} lx or more": "{threshold} lx ou mais",
}
