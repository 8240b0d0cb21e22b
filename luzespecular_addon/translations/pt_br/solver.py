"""What the solver says: its stages and messages."""

from __future__ import annotations

STAGES = {
    "planes": "planos",
    "fracture": "fracionamento",
    "visibility and form factors": "visibilidade e fatores de forma",
    "specular chains": "cadeias especulares",
    "prepared": "preparado",
    "sky": "céu",
    "sun": "Sol",
    "interreflection": "inter-reflexão",
    "solved": "calculado",
    "work planes": "planos de trabalho",
}

# What the solver refuses or remarks, by the templates of its messages: a test holds them to the solver's source.
SOLVER = {
    "The scene has no surfaces; add at least one with scene.add(name, vertices, material)": (
        "A cena não tem superfícies; adicione ao menos uma"
    ),
    "Surface '{name}' is in the scene already; give each surface a name of its own": (
        "A superfície '{name}' já está na cena; dê a cada superfície um nome próprio"
    ),
    "Surface '{name}' has {count} vertices; a {kind} needs at least 3": (
        "A superfície '{name}' tem {count} vértices ({kind}); são precisos ao menos 3"
    ),
    "Surface '{name}': vertex {vertex} is {place}; mend or remove it ({count} in all)": (
        "Superfície '{name}': o vértice {vertex} é {place}; corrija-o ou retire-o ({count} ao todo)"
    ),
    "Surface '{name}': the polygon's edges cross each other; split it or reorder its vertices": (
        "Superfície '{name}': as arestas do polígono se cruzam; divida-o ou reordene seus vértices"
    ),
    "Surface '{name}': the edges of face {face} cross each other; split it or reorder its vertices": (
        "Superfície '{name}': as arestas da face {face} se cruzam; divida-a ou reordene seus vértices"
    ),
    "Surface '{name}' is not flat: a vertex lies {distance} m off its plane; "
    "move it, or add the surface as a mesh of triangles": (
        "A superfície '{name}' não é plana: um vértice está a {distance} m do plano; "
        "mova-o, ou divida a superfície em triângulos"
    ),
    "Surface '{name}' has no area: its vertices repeat or lie on one line; mend or remove it": (
        "A superfície '{name}' não tem área: seus vértices se repetem ou estão em uma reta; corrija-a ou retire-a"
    ),
    "Surface '{name}' has no face with an area; mend or remove it": (
        "A superfície '{name}' não tem face com área; corrija-a ou retire-a"
    ),
    "Surface '{name}': face {face} names a vertex outside 0 … {last}; mend the face": (
        "Superfície '{name}': a face {face} cita um vértice fora de 0 … {last}; corrija a face"
    ),
    "Material: {value} is {number}; it cannot be negative": "Material: {value} é {number}; não pode ser negativo",
    "Material: {value} is {number}; give a share between 0 and 1 (not percent)": (
        "Material: {value} é {number}; dê uma parcela entre 0 e 1 (não porcentagem)"
    ),
    "Material: diffuse_reflectance + specular_reflectance + regular_transmittance = {total}; lower them to at most 1": (
        "Material: refletância difusa + refletância especular + transmitância regular = {total}; "
        "reduza-as a no máximo 1"
    ),
    "Material: refractive_index is {number}; it must be above 1 (window glass: 1.52)": (
        "Material: o índice de refração é {number}; deve ser maior que 1 (vidro de janela: 1,52)"
    ),
    "Material: regular_transmittance {transmittance} is more than the {clearest} that "
    "a pane of refractive index {number} can have; lower one of the two": (
        "Material: a transmitância regular {transmittance} é maior que a de {clearest} que "
        "um vidro de índice de refração {number} pode ter; reduza um dos dois"
    ),
    "max_area {area} m² would cut the scene into some {count} faces, more than {most}; "
    "raise it to {enough} m² or more": (
        "A maior face de {area} m² dividiria a cena em umas {count} faces, mais que {most}; "
        "aumente-a para {enough} m² ou mais"
    ),
    "bands must lie between 2 and {most}, not {number}; 60 is usual": (
        "As faixas devem ser de 2 a {most}, não {number}; 60 é o usual"
    ),
    "The scene needs {needed} GB for {receivers} receivers, more than the {memory} GB "
    "of 'memory'; raise max_area, lower bands, or allow more memory": (
        "A cena precisa de {needed} GB para {receivers} receptores, mais que os {memory} GB permitidos; "
        "aumente a maior face, reduza as faixas, ou permita mais memória"
    ),
    "Light multiplies without end: a closed scene of diffuse reflectance 1 has no steady state; "
    "lower the reflectances below 1": (
        "A luz se multiplica sem fim: uma cena fechada de refletância difusa 1 não tem regime permanente; "
        "reduza as refletâncias abaixo de 1"
    ),
    "Surface '{name}': some of its faces lie on one another; remove the doubles": (
        "Superfície '{name}': algumas de suas faces estão umas sobre as outras; retire as repetidas"
    ),
    "Surfaces '{one}' and '{two}' lie on one another in one plane; remove what is doubled": (
        "As superfícies '{one}' e '{two}' estão uma sobre a outra no mesmo plano; retire o que se repete"
    ),
    "Surfaces '{one}' and '{two}' lie on one another in one plane with different materials, so "
    "which of them light meets is not defined; remove one, or move them apart": (
        "As superfícies '{one}' e '{two}' estão uma sobre a outra no mesmo plano, com materiais diferentes, e não se "
        "define qual delas a luz encontra; retire uma, ou afaste-as"
    ),
    "{count} more pairs of surfaces lie on one another": ("Mais {count} pares de superfícies estão uma sobre a outra"),
    "All surfaces look outward and none sees another; if this is a room seen from inside, turn its normals "
    "(reverse the order of the vertices)": (
        "Todas as superfícies olham para fora e nenhuma vê outra; se este é um ambiente visto de dentro, vire suas "
        "normais (inverta a ordem dos vértices)"
    ),
    "its faces look to different sides: across {count} edges neighbours are turned over; recalculate its normals": (
        "suas faces olham para lados diferentes: em {count} arestas as vizinhas estão viradas; recalcule as normais"
    ),
    "Cancelled during '{stage}'": "Cancelado durante '{stage}'",
}
