"""What the user is told about the scene."""

from __future__ import annotations

TEXTS = {
    "There is no scene '{name}': choose one of {known}": "Não há a cena '{name}': escolha uma destas: {known}",
    "'{path}' is the file that is open: choose another --out": "'{path}' é o arquivo aberto: escolha outro --out",
    "There is no day {day} in month {month} of {year}: set another date": (
        "Não há o dia {day} no mês {month} de {year}: escolha outra data"
    ),
    "The Sun is below the horizon ({altitude:.1f}°): there is no sunlight, only the sky is solved": (
        "O Sol está abaixo do horizonte ({altitude:.1f}°): não há luz solar, só o céu é calculado"
    ),
    "There is no light at {hour}: the Sun is down or off, there is no sky, no surface is luminous. Set hour or sky": (
        "Não há luz às {hour}: o Sol está abaixo do horizonte ou desligado, não há céu nem superfície luminosa. "
        "Ajuste a hora ou o céu"
    ),
    "The scene changed while it was solved, so the results were thrown away: solve again": (
        "A cena mudou durante o cálculo, por isso os resultados foram descartados: calcule de novo"
    ),
    "There is nothing to light: the scene has no object with faces that renders. "
    "Add one, or enable its render visibility": (
        "Não há o que iluminar: a cena não tem objeto com faces visível na renderização. "
        "Adicione um, ou ative sua visibilidade na renderização"
    ),
    "Object '{name}' is in Edit Mode: leave Edit Mode (Tab), then solve": (
        "O objeto '{name}' está em modo de edição: saia dele (Tab) e então calcule"
    ),
    "Object '{name}' has no mesh data and is left out: convert it to a mesh, or set its role to Ignore": (
        "O objeto '{name}' não tem dados de malha e fica de fora: converta-o em malha, ou defina seu papel como Ignorar"
    ),
    "Object '{name}' has no faces and is left out: give it faces, or set its role to Ignore": (
        "O objeto '{name}' não tem faces e fica de fora: dê-lhe faces, ou defina seu papel como Ignorar"
    ),
    "Light '{name}' is left out: the Sun comes from site and time, lamps from luminous materials": (
        "A luz '{name}' fica de fora: o Sol vem do local e da hora, as lâmpadas de materiais luminosos"
    ),
    "Object '{name}' has vertices or a transform that are not finite numbers (NaN): "
    "mend them, or set its role to Ignore": (
        "O objeto '{name}' tem vértices ou uma transformação que não são números finitos (NaN): "
        "corrija-os, ou defina seu papel como Ignorar"
    ),
    "Object '{name}' has no face with an area and is left out: check its scale, or set its role to Ignore": (
        "O objeto '{name}' não tem face com área e fica de fora: confira sua escala, ou defina seu papel como Ignorar"
    ),
    "Keyframes move or change {names}: the results are those of frame {frame}": (
        "Quadros-chave movem ou mudam {names}: os resultados são os do quadro {frame}"
    ),
    "Object '{name}': {count} faces without area are left out; Merge by Distance mends it": (
        "Objeto '{name}': {count} faces sem área ficam de fora; Fundir por distância corrige isso"
    ),
    "Object '{name}' is a solid pane: light passes two of its faces, and the glass's mirror reflection is "
    "neglected. Model the pane as single faces for exact results": (
        "O objeto '{name}' é um vidro sólido: a luz atravessa duas de suas faces, e a reflexão especular do vidro é "
        "desprezada. Modele o vidro com faces simples para resultados exatos"
    ),
    "Object '{name}' has an attribute '{attribute}' that results would overwrite: rename it": (
        "O objeto '{name}' tem um atributo '{attribute}' que os resultados sobrescreveriam: renomeie-o"
    ),
    "Without material, so a diffuse reflectance of {value:g} is used: {names}": (
        "Sem material, por isso é usada uma refletância difusa de {value:g}: {names}"
    ),
    "Instances and objects that share a mesh have results on the fine faces only: {names}": (
        "Instâncias e objetos que compartilham uma malha têm resultados só nas faces finas: {names}"
    ),
    "Material '{name}': {remark}": "Material '{name}': {remark}",
    "Material '{name}': {error}. See Properties > Material > LuzEspecular": (
        "Material '{name}': {error}. Veja Propriedades > Material > LuzEspecular"
    ),
    "its input '{name}' comes from other nodes; the viewport colour is used": (
        "sua entrada '{name}' vem de outros nós; usa-se a cor da vista 3D"
    ),
    "its input '{name}' comes from other nodes; {value:g} is used": (
        "sua entrada '{name}' vem de outros nós; usa-se {value:g}"
    ),
    "There is not enough memory: choose a coarser fineness, or a larger largest face": (
        "Não há memória suficiente: escolha um refinamento menor, ou uma maior face mais ampla"
    ),
    "its shader '{node}' cannot be read; the viewport colour is used": (
        "seu sombreador '{node}' não pode ser lido; usa-se a cor da vista 3D"
    ),
}
