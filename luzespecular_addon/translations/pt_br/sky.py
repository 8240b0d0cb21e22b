"""Sky, Sun and ground."""

from __future__ import annotations

OPERATORS = {
    "Add Sky Preset": "Adicionar predefinição de céu",
}

TEXTS = {
    "Sky": "Céu",
    "Sky, Sun and ground": "Céu, Sol e solo",
    "Sky and its illuminance": "Céu e sua iluminância",
    "Clear": "Claro",
    "Intermediate": "Parcialmente nublado",
    "Overcast": "Encoberto",
    "CIE type": "Tipo CIE",
    "None": "Nenhum",
    "No sky: the Sun and luminous surfaces only": "Sem céu: apenas o Sol e as superfícies luminosas",
    "CIE Type": "Tipo CIE",
    "Type of the CIE standard general sky (ISO 15469)": "Tipo do céu padrão geral da CIE (ISO 15469)",
    "1 Overcast, steep gradation": "1 Encoberto, gradação acentuada",
    "CIE standard overcast sky: steep gradation, the same in all azimuths": (
        "Céu encoberto padrão da CIE: gradação acentuada, igual em todos os azimutes"
    ),
    "2 Overcast, steep, brighter to the Sun": "2 Encoberto, acentuado, mais claro junto ao Sol",
    "Steep gradation, slight brightening towards the Sun": "Gradação acentuada, pouco mais claro em direção ao Sol",
    "3 Overcast, moderate gradation": "3 Encoberto, gradação moderada",
    "Moderate gradation, the same in all azimuths": "Gradação moderada, igual em todos os azimutes",
    "4 Overcast, moderate, brighter to the Sun": "4 Encoberto, moderado, mais claro junto ao Sol",
    "Moderate gradation, slight brightening towards the Sun": "Gradação moderada, pouco mais claro em direção ao Sol",
    "5 Uniform": "5 Uniforme",
    "The same luminance everywhere": "A mesma luminância em toda parte",
    "6 Partly cloudy, brighter to the Sun": "6 Parcialmente nublado, mais claro junto ao Sol",
    "No gradation, slight brightening towards the Sun": "Sem gradação, pouco mais claro em direção ao Sol",
    "7 Partly cloudy, brighter around the Sun": "7 Parcialmente nublado, mais claro ao redor do Sol",
    "No gradation, brighter circumsolar region": "Sem gradação, região circunsolar mais clara",
    "8 Partly cloudy, solar corona": "8 Parcialmente nublado, coroa solar",
    "No gradation, distinct solar corona": "Sem gradação, coroa solar nítida",
    "9 Partly cloudy, Sun obscured": "9 Parcialmente nublado, Sol encoberto",
    "With the obscured Sun": "Com o Sol encoberto",
    "10 Partly cloudy, graded, brighter around the Sun": "10 Parcialmente nublado, graduado, claro ao redor do Sol",
    "With a brighter circumsolar region": "Com a região circunsolar mais clara",
    "11 White-blue, solar corona": "11 Azul-esbranquiçado, coroa solar",
    "White-blue sky with distinct solar corona": "Céu azul-esbranquiçado com coroa solar nítida",
    "12 Clear, clean air": "12 Claro, ar limpo",
    "CIE standard clear sky, low luminance turbidity": "Céu claro padrão da CIE, baixa turbidez",
    "13 Clear, polluted air": "13 Claro, ar poluído",
    "CIE standard clear sky, polluted atmosphere": "Céu claro padrão da CIE, atmosfera poluída",
    "14 Turbid, broad corona": "14 Turvo, coroa larga",
    "Cloudless turbid sky with broad solar corona": "Céu turvo sem nuvens com coroa solar larga",
    "15 White-blue turbid, broad corona": "15 Azul-esbranquiçado turvo, coroa larga",
    "White-blue turbid sky with broad solar corona": "Céu azul-esbranquiçado turvo com coroa solar larga",
    "16 Traditional overcast": "16 Encoberto tradicional",
    "Moon and Spencer: the horizon is a third as bright as the zenith": (
        "Moon e Spencer: o horizonte tem um terço da luminância do zênite"
    ),
    "Sky (lx)": "Céu (lx)",
    "Diffuse illuminance of the sky alone on an open horizontal plane": (
        "Iluminância difusa, só do céu, em um plano horizontal desobstruído"
    ),
    "Sun": "Sol",
    "Let the Sun shine": "Deixar o Sol brilhar",
    "Sun (lx)": "Sol (lx)",
    "Illuminance by the Sun on a plane that faces it": "Iluminância do Sol em um plano perpendicular aos seus raios",
    "Ground Reflectance": "Refletância do solo",
    "Reflectance of the open ground around the scene: 0.2 for grass or soil, 0 for no light from below": (
        "Refletância do solo aberto ao redor da cena: 0,2 para grama ou terra, 0 para nenhuma luz de baixo"
    ),
    "Clear sky with Sun (CIE type 12)": "Céu claro com Sol (tipo CIE 12)",
    "Partly cloudy sky with a dim Sun (CIE type 10)": "Céu parcialmente nublado com Sol fraco (tipo CIE 10)",
    "Overcast sky without Sun (traditional, type 16)": "Céu encoberto sem Sol (tradicional, tipo 16)",
    "One of the CIE standard general skies, by its number": "Um dos céus padrão gerais da CIE, por seu número",
    "Where the illuminances of sky and Sun come from": "De onde vêm as iluminâncias do céu e do Sol",
    "By Model": "Modelo",
    "Mean illuminances by date and Sun altitude (IES daylight availability, RP-21)": (
        "Iluminâncias médias pela data e pela altura do Sol (disponibilidade de luz natural da IES, RP-21)"
    ),
    "By Value": "Valor",
    "The illuminances given here": "As iluminâncias informadas aqui",
    "Solar Disc": "Disco solar",
    "Soft edges of shadows by the disc of 0.533° that the Sun is; takes longer": (
        "Bordas suaves das sombras pelo disco de 0,533° que o Sol é; demora mais"
    ),
    "Sky: {lux:,.0f} lx": "Céu: {lux:,.0f} lx",
    "Sun: {lux:,.0f} lx facing it": "Sol: {lux:,.0f} lx de frente",
    "Skies": "Céus",
    "Skies saved by the user": "Céus salvos pelo usuário",
    "Save or remove a preset: sky, Sun and ground": "Salvar ou remover uma predefinição: céu, Sol e solo",
}
