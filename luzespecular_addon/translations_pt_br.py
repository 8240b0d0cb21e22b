"""Brazilian Portuguese: operators, the solver's stages and messages, and all other texts of the interface."""

from __future__ import annotations

OPERATORS = {
    "Cancel": "Cancelar",
    "Clear Results": "Limpar resultados",
    "Copy from Shader": "Copiar do sombreador",
    "Save Table": "Salvar tabela",
    "Solve": "Calcular",
}

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

_PANELS = {
    "LuzEspecular": "LuzEspecular",
    "Site & Time": "Local e hora",
    "Sky": "Céu",
    "Surfaces": "Superfícies",
    "Results": "Resultados",
    "Solve, progress and cancel": "Calcular, andamento e cancelar",
    "Place, date and hour": "Lugar, data e hora",
    "Sky, Sun and ground": "Céu, Sol e solo",
    "The part the active object plays": "O papel do objeto ativo",
    "What is shown, and the table of surfaces": "O que é mostrado, e a tabela das superfícies",
    "Photometric values of the active material": "Valores fotométricos do material ativo",
    "Black: absorbs all light": "Preto: absorve toda a luz",
    "Select an object to set its role": "Selecione um objeto para definir seu papel",
    "No results yet": "Ainda não há resultados",
    "Surface [lx]": "Superfície [lx]",
    "Min": "Mín",
    "Mean": "Média",
    "Max": "Máx",
    "Not absorbed: {share:.3f} of 1": "Não absorvido: {share:.3f} de 1",
    "Sun: altitude {altitude:.1f}°, azimuth {azimuth:.1f}°": "Sol: altura {altitude:.1f}°, azimute {azimuth:.1f}°",
    "Sunrise {rise}, sunset {fall}": "Nascer {rise}, pôr do sol {fall}",
    "The Sun is below the horizon: only the sky is solved": "O Sol está abaixo do horizonte: só o céu é calculado",
    "The Sun neither rises nor sets": "O Sol não nasce nem se põe",
    "{name}: {area:.2f} m², uniformity {uniformity:.2f}": "{name}: {area:.2f} m², uniformidade {uniformity:.2f}",
    "{name} (back)": "{name} (verso)",
    "Mean {mean:.1f} lx, from {minimum:.1f} to {maximum:.1f}": (
        "Média {mean:.1f} lx, de {minimum:.1f} a {maximum:.1f}"
    ),
    "Illuminance": "Iluminância",
    "not computed": "não calculado",
    "clock time": "hora legal",
    "solar time": "hora solar",
    "no material": "sem material",
}

_SITE = {
    "Latitude": "Latitude",
    "Degrees, north positive": "Graus, positivos ao norte",
    "Longitude": "Longitude",
    "Degrees, east positive": "Graus, positivos a leste",
    "Time Zone": "Fuso horário",
    "Hours that clocks are ahead of UTC, summer time included": (
        "Horas que os relógios estão adiantados em relação ao UTC, incluído o horário de verão"
    ),
    "Day": "Dia",
    "Day of the month": "Dia do mês",
    "Month": "Mês",
    "Month of the year": "Mês do ano",
    "Year": "Ano",
    "Year of the date": "Ano da data",
    "Time": "Hora",
    "What the hour means": "O que a hora significa",
    "Solar": "Solar",
    "At 12 the Sun stands highest": "Às 12 o Sol está no ponto mais alto",
    "Clock": "Relógio",
    "Local clock time of the time zone": "Hora legal do fuso horário",
    "Hour": "Hora",
    "Hour of the day, with decimals: 9.5 is half past nine": "Hora do dia, com decimais: 9,5 são nove e meia",
    "North Offset": "Desvio do norte",
    "Angle in degrees from the +Y axis to true north, clockwise seen from above": (
        "Ângulo em graus do eixo +Y ao norte verdadeiro, no sentido horário visto de cima"
    ),
}

_SKY = {
    "Sky and its illuminance": "Céu e sua iluminância",
    "Clear": "Claro",
    "Clear sky with Sun; illuminances by the availability model, from date and Sun altitude": (
        "Céu claro com Sol; iluminâncias pelo modelo de disponibilidade, a partir da data e da altura do Sol"
    ),
    "Intermediate": "Parcialmente nublado",
    "Partly cloudy sky; illuminances by the availability model": (
        "Céu parcialmente nublado; iluminâncias pelo modelo de disponibilidade"
    ),
    "Overcast": "Encoberto",
    "Overcast sky without Sun; illuminances by the availability model": (
        "Céu encoberto sem Sol; iluminâncias pelo modelo de disponibilidade"
    ),
    "CIE type": "Tipo CIE",
    "A CIE standard general sky with the illuminances that you give": (
        "Um céu padrão geral da CIE com as iluminâncias que você informar"
    ),
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
    "Sky Illuminance (lx)": "Iluminância do céu (lx)",
    "Diffuse illuminance of the sky alone on an open horizontal plane": (
        "Iluminância difusa, só do céu, em um plano horizontal desobstruído"
    ),
    "Sun": "Sol",
    "Let the Sun shine": "Deixar o Sol brilhar",
    "Sun Illuminance (lx)": "Iluminância do Sol (lx)",
    "Illuminance by the Sun on a plane that faces it": "Iluminância do Sol em um plano perpendicular aos seus raios",
    "Ground Reflectance": "Refletância do solo",
    "Reflectance of the open ground around the scene: 0.2 for grass or soil, 0 for no light from below": (
        "Refletância do solo aberto ao redor da cena: 0,2 para grama ou terra, 0 para nenhuma luz de baixo"
    ),
}

_SURFACES = {
    "Role": "Papel",
    "The part this object plays in the daylight calculation": "O papel deste objeto no cálculo da luz natural",
    "Receiver": "Receptor",
    "Blocks and reflects light, and gets results": "Obstrui e reflete luz, e recebe resultados",
    "Obstruction": "Obstrução",
    "Blocks and reflects light, but gets no results": "Obstrui e reflete luz, mas não recebe resultados",
    "Ignore": "Ignorar",
    "Takes no part": "Não participa",
    "Lit Sides": "Lados iluminados",
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
}

_MATERIALS = {
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
}

_ACCURACY = {
    "Fineness": "Refinamento",
    "How finely surfaces and sky are divided": "Quão finamente se dividem as superfícies e o céu",
    "Draft": "Rascunho",
    "A first look: a quarter of the faces, a coarser globe": (
        "Uma primeira olhada: um quarto das faces, um globo mais grosseiro"
    ),
    "Normal": "Normal",
    "Faces chosen for the scene, a globe of 60 bands": "Faces escolhidas para a cena, um globo de 60 faixas",
    "Fine": "Fino",
    "Four times the faces, a globe of 90 bands": "Quatro vezes mais faces, um globo de 90 faixas",
    "Expert": "Especialista",
    "The numbers given here": "Os números informados aqui",
    "Bands": "Faixas",
    "Bands of the globe from zenith to nadir; 60 make 5,902 parcels": (
        "Faixas do globo do zênite ao nadir; 60 formam 5.902 parcelas"
    ),
    "Largest Face (m²)": "Maior face (m²)",
    "Faces are divided until none is larger; 0 lets the solver choose": (
        "As faces são divididas até que nenhuma seja maior; 0 deixa a escolha para o cálculo"
    ),
}

_DISPLAY = {
    "Show On": "Mostrar em",
    "What carries the false colours in the viewport": "O que leva as cores falsas na vista 3D",
    "Fine Faces": "Faces finas",
    "A separate object that holds the solver's own fine faces; your objects are hidden meanwhile": (
        "Um objeto separado com as faces finas do próprio cálculo; enquanto isso seus objetos ficam ocultos"
    ),
    "Own Meshes": "Malhas próprias",
    "Your own faces, each with its mean illuminance": "Suas próprias faces, cada uma com sua iluminância média",
    "Backs": "Versos",
    "Show the fine faces of backs; without them one looks through walls from outside into the room": (
        "Mostrar as faces finas dos versos; sem elas vê-se de fora, através das paredes, o interior"
    ),
    "Quantity": "Grandeza",
    "Which part of the light the fine faces show": "Que parte da luz as faces finas mostram",
    "Total": "Total",
    "All light, interreflection included": "Toda a luz, incluída a inter-reflexão",
    "Initial": "Inicial",
    "Before any diffuse reflection: sky, Sun and luminous surfaces, direct and by mirrors": (
        "Antes de qualquer reflexão difusa: céu, Sol e superfícies luminosas, direto e por espelhos"
    ),
    "Sky, direct": "Céu, direto",
    "Light straight from the sky and the ground": "Luz que vem direto do céu e do solo",
    "Sky, by mirrors": "Céu, por espelhos",
    "Sky light through mirrors and panes": "Luz do céu por espelhos e vidros",
    "Sun, direct": "Sol, direto",
    "Light straight from the Sun": "Luz que vem direto do Sol",
    "Sun, by mirrors": "Sol, por espelhos",
    "Sunlight through mirrors and panes": "Luz do Sol por espelhos e vidros",
    "Luminous surfaces": "Superfícies luminosas",
    "Light from surfaces that emit by themselves, their mirror images included": (
        "Luz de superfícies que emitem por si, incluídas suas imagens em espelhos"
    ),
    "Interreflected": "Inter-refletida",
    "Light that has met a diffuse surface": "Luz que encontrou alguma superfície difusa",
    "Scale": "Escala",
    "False-colour scale": "Escala de cores falsas",
    "Viridis": "Viridis",
    "Even steps of lightness, safe for the colour-blind": "Passos iguais de claridade, segura para daltônicos",
    "Cividis": "Cividis",
    "Blue to yellow, made for the colour-blind": "Do azul ao amarelo, feita para daltônicos",
    "Inferno": "Inferno",
    "Black through red to pale yellow, even steps of lightness": (
        "Do preto ao amarelo pálido pelo vermelho, passos iguais de claridade"
    ),
    "Spectrum": "Espectro",
    "Blue through green to red, as lighting programs made common": (
        "Do azul ao vermelho pelo verde, como é comum em programas de iluminação"
    ),
    "Grey": "Cinza",
    "Dark to light grey": "Do cinza escuro ao claro",
    "Steps": "Passos",
    "How values are spread over the colours": "Como os valores se distribuem pelas cores",
    "Logarithmic": "Logarítmica",
    "Equal ratios are equally far apart, as the eye judges": "Razões iguais ficam equidistantes, como o olho julga",
    "Linear": "Linear",
    "Equal differences are equally far apart": "Diferenças iguais ficam equidistantes",
    "Fixed Range": "Intervalo fixo",
    "Keep the ends of the scale instead of fitting them": "Manter os extremos da escala em vez de ajustá-los",
    "From (lx)": "De (lx)",
    "Illuminance at the low end of the scale": "Iluminância no extremo inferior da escala",
    "To (lx)": "Até (lx)",
    "Illuminance at the high end of the scale": "Iluminância no extremo superior da escala",
    "Legend": "Legenda",
    "Draw the legend in the 3D viewport": "Desenhar a legenda na vista 3D",
    "Date, hour and sky of the results": "Data, hora e céu dos resultados",
}

_ACTIONS = {
    "Calculate the daylight of the scene and show it in false colours": (
        "Calcular a luz natural da cena e mostrá-la em cores falsas"
    ),
    "Stop the calculation; nothing is changed": "Parar o cálculo; nada é alterado",
    "Remove all results from the scene: attributes, colours, the fine faces and the tables": (
        "Remover todos os resultados da cena: atributos, cores, as faces finas e as tabelas"
    ),
    "Copy the values that the shader stands for, to change them by hand": (
        "Copiar os valores que o sombreador representa, para alterá-los à mão"
    ),
    "Save the table of surfaces as a CSV file": "Salvar a tabela das superfícies em um arquivo CSV",
    "A calculation is running: wait for it, or cancel it": "Há um cálculo em andamento: espere por ele ou cancele-o",
    "Leave Edit Mode first (Tab)": "Saia antes do modo de edição (Tab)",
    "There are no results yet: solve first": "Ainda não há resultados: calcule antes",
    "Cancelled; nothing was changed": "Cancelado; nada foi alterado",
    "Solved: {title}; {count} faces": "Calculado: {title}; {count} faces",
    "LuzEspecular: {percent:.0f} % {stage} (Esc cancels)": "LuzEspecular: {percent:.0f} % {stage} (Esc cancela)",
    "The table could not be saved: {error}": "Não foi possível salvar a tabela: {error}",
}

_NOTICES = {
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
    "Object '{name}': {count} faces without area are left out; Merge by Distance mends it": (
        "Objeto '{name}': {count} faces sem área ficam de fora; Mesclar por distância corrige isso"
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
    "Surface '{name}': {remark}": "Superfície '{name}': {remark}",
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

TEXTS = _PANELS | _SITE | _SKY | _SURFACES | _MATERIALS | _ACCURACY | _DISPLAY | _ACTIONS | _NOTICES
