"""The parts that objects play."""

from __future__ import annotations

OPERATORS = {
    "Set Role": "Definir papel",
    "Select by Role": "Selecionar por papel",
}

TEXTS = {
    "Surfaces": "Superfícies",
    "The part the active object plays": "O papel do objeto ativo",
    "Select an object to set its role": "Selecione um objeto para definir seu papel",
    "Role": "Papel",
    "The part this object plays in the daylight calculation": "O papel deste objeto no cálculo da luz natural",
    "Receiver": "Receptor",
    "Blocks and reflects light, and gets results": "Obstrui e reflete luz, e recebe resultados",
    "Obstruction": "Obstrução",
    "Blocks and reflects light, but gets no results": "Obstrui e reflete luz, mas não recebe resultados",
    "Ignore": "Ignorar",
    "Takes no part": "Não participa",
    "Lit Sides": "Lados com luz",
    "Which sides of the faces receive and reflect light; every face blocks light from both sides": (
        "Quais lados das faces recebem e refletem luz; toda face obstrui a luz dos dois lados"
    ),
    "Automatic": "Automático",
    "Closed meshes: the side that the normals look to; open meshes: both sides": (
        "Malhas fechadas: o lado para onde apontam as normais; malhas abertas: os dois lados"
    ),
    "Front Only": "Só a frente",
    "The side that the normals look to; the other side is black": (
        "O lado para onde apontam as normais; o outro lado é preto"
    ),
    "Both": "Ambos",
    "Both sides, each by itself": "Os dois lados, cada um por si",
    "Give to Selected": "Dar aos selecionados",
    "Give all selected objects the role of the active one, and its lit sides": (
        "Dar a todos os objetos selecionados o papel do ativo, e seus lados iluminados"
    ),
    "Select several objects; the active one's role is given to the others": (
        "Selecione vários objetos; o papel do ativo é dado aos outros"
    ),
    "Role given to {count} objects": "Papel dado a {count} objetos",
    "Select all visible objects that play this part": "Selecionar todos os objetos visíveis com este papel",
    "The part the objects play": "O papel dos objetos",
}
