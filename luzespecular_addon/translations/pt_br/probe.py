"""Readings under the mouse."""

from __future__ import annotations

OPERATORS = {
    "Probe": "Sonda",
    "Clear Readings": "Limpar leituras",
}

TEXTS = {
    "Read the light under the mouse: total, components, error. Click keeps a reading shown, Esc ends": (
        "Ler a luz sob o mouse: total, componentes, erro. Um clique mantém a leitura visível, Esc termina"
    ),
    "Probe: click keeps the reading shown; Esc or right click ends": (
        "Sonda: um clique mantém a leitura visível; Esc ou o botão direito termina"
    ),
    "Keep Reading": "Manter leitura",
    "Take the kept readings away": "Retirar as leituras mantidas",
    "No reading is kept: click while probing": "Nenhuma leitura foi mantida: clique durante a sondagem",
    "Other side": "Outro lado",
}
