"""What the solver says: its stages, kinds of findings and messages."""

from __future__ import annotations

STAGES = {
    "starting": "começando",
    "planes": "planos",
    "scene check": "verificação da cena",
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

KINDS = {
    "costly detail": "detalhe custoso",
    "deep mirror chains": "cadeias longas de espelhos",
    "empty": "vazio",
    "endless mirrors": "espelhos sem fim",
    "endless reflection": "reflexão sem fim",
    "far away": "longe da origem",
    "gap": "fresta",
    "glass twice": "vidro em dobro",
    "inside out": "do avesso",
    "inverted normals": "normais invertidas",
    "many panes": "muitos vidros",
    "no area": "sem área",
    "no material": "sem valores de material",
    "no opening": "sem abertura",
    "not flat": "não plana",
    "overlap": "sobreposição",
    "reflectance": "refletância",
    "seen from behind": "vista por trás",
    "tiny faces": "faces minúsculas",
    "turned over": "faces viradas",
    "turned over in a mesh": "faces viradas na malha",
    "unit": "unidade",
}

# What the solver refuses or remarks, by the templates of its messages: a test holds them to the solver's source.
# {more} stands for a remark in brackets, or for nothing.
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
    "Surface '{name}': the polygon crosses itself at a corner or covers a part twice; "
    "split it or reorder its vertices": (
        "Superfície '{name}': o polígono se cruza em um canto ou cobre uma parte duas vezes; divida-o ou reordene seus "
        "vértices"
    ),
    "Surface '{name}': face {row} crosses itself at a corner or covers a part twice; "
    "split it or reorder its vertices": (
        "Superfície '{name}': a face {row} se cruza em um canto ou cobre uma parte duas vezes; "
        "divida-a ou reordene seus vértices"
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
    "A largest face of {area} m² would cut the scene into some {count} faces, more than {most}; "
    "raise it to {enough} m² or more": (
        "A maior face de {area} m² dividiria a cena em umas {count} faces, mais que {most}; "
        "aumente-a para {enough} m² ou mais"
    ),
    "bands must lie between 2 and {most}, not {number}; 60 is usual": (
        "As faixas devem ser de 2 a {most}, não {number}; 60 é o usual"
    ),
    "The scene needs {needed} GB for {receivers} receivers, more than the {memory} GB that it may take; "
    "raise Largest Face or lower Bands (Accuracy: Expert), or choose a coarser fineness": (
        "A cena precisa de {needed} GB para {receivers} receptores, mais que os {memory} GB que pode tomar; "
        "aumente Maior face ou reduza Faixas (Exatidão: Especialista), ou escolha um refinamento menor"
    ),
    "Light multiplies without end: a closed scene of diffuse reflectance 1 has no steady state; "
    "lower the reflectances below 1": (
        "A luz se multiplica sem fim: uma cena fechada de refletância difusa 1 não tem regime permanente; "
        "reduza as refletâncias abaixo de 1"
    ),
    "Cancelled during '{stage}'": "Cancelado durante '{stage}'",
    # what the scene check finds: messages and remedies, each by itself
    "Surface '{name}': some of its faces lie on one another": (
        "Superfície '{name}': algumas de suas faces estão umas sobre as outras"
    ),
    "remove the doubles": "retire as repetidas",
    "Surfaces '{one}' and '{two}' lie on one another in one plane": (
        "As superfícies '{one}' e '{two}' estão uma sobre a outra no mesmo plano"
    ),
    "remove what is doubled": "retire o que se repete",
    "Surfaces '{one}' and '{two}' lie on one another in one plane with different materials, so "
    "which of them light meets is not defined": (
        "As superfícies '{one}' e '{two}' estão uma sobre a outra no mesmo plano, com materiais diferentes, e não se "
        "define qual delas a luz encontra"
    ),
    "remove one, or move them apart": "retire uma, ou afaste-as",
    "cut an opening for '{pane}' into '{wall}', or move them apart": (
        "recorte uma abertura para '{pane}' em '{wall}', ou afaste-as"
    ),
    "Surface '{name}' is a solid {width} mm thick that light goes straight through: "
    "it passes two panes, each with the whole transmittance": (
        "A superfície '{name}' é um sólido de {width} mm de espessura que a luz atravessa: "
        "ela passa por dois vidros, cada um com toda a transmitância"
    ),
    "draw the pane as one sheet": "desenhe o vidro como uma só folha",
    "{count} more pairs of surfaces lie on one another": "Mais {count} pares de superfícies estão uma sobre a outra",
    "All surfaces look outward and none sees another": "Todas as superfícies olham para fora e nenhuma vê outra",
    "if this is a room seen from inside, turn its normals (Edit Mode: Mesh > Normals > Recalculate Inside)": (
        "se este é um ambiente visto de dentro, vire suas normais (modo de edição: Malha > Normais > Recalcular para "
        "dentro)"
    ),
    "Surface '{name}': its faces look to different sides: across {count} edges neighbours are turned over": (
        "Superfície '{name}': suas faces olham para lados diferentes: em {count} arestas as vizinhas estão viradas"
    ),
    "recalculate its normals (Edit Mode: Mesh > Normals > Recalculate Outside)": (
        "recalcule as normais (modo de edição: Malha > Normais > Recalcular para fora)"
    ),
    "Surface '{name}': {count} faces without area left out": (
        "Superfície '{name}': {count} faces sem área deixadas de fora"
    ),
    "merge their vertices (Edit Mode: Mesh > Merge > By Distance) or remove them": (
        "una seus vértices (modo de edição: Malha > Fundir > Por distância) ou retire-as"
    ),
    "Surface '{name}': {count} faces that are not flat cut into triangles": (
        "Superfície '{name}': {count} faces que não são planas divididas em triângulos"
    ),
    "flatten them, or cut them as you want them": "aplaine-as, ou divida-as como quiser",
    "Surfaces '{one}' and '{two}' lie side by side in one plane and look to opposite sides": (
        "As superfícies '{one}' e '{two}' estão lado a lado no mesmo plano e olham para lados opostos"
    ),
    "turn the normals of one of them (Edit Mode: Mesh > Normals > Flip)": (
        "vire as normais de uma delas (modo de edição: Malha > Normais > Virar)"
    ),
    "Surface '{name}' has its back to {others} and its front sees nothing{more}": (
        "A superfície '{name}' está de costas para {others} e sua frente não vê nada{more}"
    ),
    " (of its {every} planes the {some} largest were looked at, others may be alike)": (
        " (de seus {every} planos foram vistos os {some} maiores, outros podem ser iguais)"
    ),
    "turn its normals (Edit Mode: Mesh > Normals > Flip), or set its Lit Sides to Both": (
        "vire suas normais (modo de edição: Malha > Normais > Virar), ou escolha Ambos em Lados com luz"
    ),
    "Surface '{name}' is seen from behind by {others}, where it is black: it has one side only{more}": (
        "A superfície '{name}' é vista por trás por {others}, onde é preta: só tem um lado{more}"
    ),
    "turn its normals (Edit Mode: Mesh > Normals > Flip), set its Lit Sides to Both, or give it a thickness "
    "(Solidify modifier)": (
        "vire suas normais (modo de edição: Malha > Normais > Virar), escolha Ambos em Lados com luz, ou dê-lhe "
        "espessura (modificador Solidificar)"
    ),
    "Between '{one}' and '{two}' is a gap up to {width} mm wide and {length} m long, through which light leaks": (
        "Entre '{one}' e '{two}' há uma fresta de até {width} mm de largura e {length} m de comprimento, por onde vaza "
        "luz"
    ),
    "Within '{name}' is a gap up to {width} mm wide and {length} m long, through which light leaks": (
        "Em '{name}' há uma fresta de até {width} mm de largura e {length} m de comprimento, por onde vaza luz"
    ),
    "move their edges together, or join the objects and merge their vertices (Edit Mode: Mesh > Merge > By Distance)": (
        "junte suas arestas, ou una os objetos e seus vértices (modo de edição: Malha > Fundir > Por distância)"
    ),
    "{count} more pairs of surfaces have gaps between them": "Mais {count} pares de superfícies têm frestas entre si",
    "Surface '{name}' has {count} faces that are tiny or thinner than a hair": (
        "A superfície '{name}' tem {count} faces minúsculas ou mais finas que um cabelo"
    ),
    "Surface '{name}' has {count} % of all polygons, and {share} % of the area": (
        "A superfície '{name}' tem {count} % de todos os polígonos, e {share} % da área"
    ),
    "simplify its mesh (Decimate modifier): it takes much time and gives little light": (
        "simplifique sua malha (modificador Decimar): ela toma muito tempo e dá pouca luz"
    ),
    "The scene is {size} m across and its surfaces mostly {length} m long": (
        "A cena tem {size} m de ponta a ponta, e suas superfícies em geral {length} m de comprimento"
    ),
    "if it was drawn in {unit}, scale it by {factor}": "se foi desenhada em {unit}, mude sua escala por {factor}",
    "The scene is {size} mm across": "A cena tem {size} mm de ponta a ponta",
    "if it was drawn in another unit, scale it to metres": "se foi desenhada em outra unidade, converta-a em metros",
    "The scene lies {distance} m from the origin, where coordinates have few digits left": (
        "A cena está a {distance} m da origem, onde restam poucos dígitos às coordenadas"
    ),
    "move it to the origin": "mova-a para a origem",
    "No light comes to {surfaces}: they enclose a space without an opening or a luminous surface": (
        "Nenhuma luz chega a {surfaces}: fecham um espaço sem abertura nem superfície luminosa"
    ),
    "open a window, or give a surface an exitance": "abra uma janela, ou dê exitância a uma superfície",
    "Surface '{name}' is black: its material has no settings": (
        "A superfície '{name}' é preta: seu material não tem ajustes"
    ),
    "give it a reflectance, or leave it if it is to swallow all light": (
        "dê-lhe uma refletância, ou deixe-a assim se deve engolir toda a luz"
    ),
    "Surface '{name}' reflects {share} % of the light": "A superfície '{name}' reflete {share} % da luz",
    "white paint reflects some 85 %, a good mirror 95 %: check its material": (
        "tinta branca reflete uns 85 %, um bom espelho 95 %: verifique seu material"
    ),
    "Between {surfaces} a look is mirrored {mean} times on average and up to {most} times, so that looking takes some "
    "{factor} times as long as without mirrors": (
        "Entre {surfaces} um olhar é espelhado {mean} vezes em média e até {most} vezes, de modo que olhar leva umas "
        "{factor} vezes o tempo sem espelhos"
    ),
    "lower their reflectances, turn them a little, or raise Specular Cut-off (Accuracy: Expert)": (
        "reduza suas refletâncias, gire-os um pouco, ou aumente Corte especular (Exatidão: Especialista)"
    ),
    "{surfaces}: seen through more than {most} panes, one behind the other. What is farther is found by one ray for "
    "each parcel, and several percent may be missing or too much": (
        "{surfaces}: vistas através de mais de {most} vidros, um atrás do outro. O que está além é encontrado por um "
        "raio por parcela, e podem faltar ou sobrar alguns por cento"
    ),
    "put one pane of the product of their transmittances for some of them, or raise bands": (
        "ponha no lugar de alguns um só vidro com o produto de suas transmitâncias, ou aumente as faixas"
    ),
    "Between {surfaces} light is mirrored without end: they enclose a space and absorb nothing": (
        "Entre {surfaces} a luz é espelhada sem fim: fecham um espaço e nada absorvem"
    ),
    "Between {surfaces} light is reflected without end: they enclose a space and absorb nothing": (
        "Entre {surfaces} a luz é refletida sem fim: fecham um espaço e nada absorvem"
    ),
    "lower their reflectances below 1, or open the space": "reduza suas refletâncias abaixo de 1, ou abra o espaço",
}
