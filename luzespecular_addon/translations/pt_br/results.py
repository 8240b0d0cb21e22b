"""Results and how they are shown."""

from __future__ import annotations

OPERATORS = {
    "Clear Results": "Limpar resultados",
    "Save Table": "Salvar tabela",
}

TEXTS = {
    "Results": "Resultados",
    "What is shown, and the table of surfaces": "O que é mostrado, e a tabela das superfícies",
    "No results yet": "Ainda não há resultados",
    "Surface": "Superfície",
    "Min": "Mín",
    "Mean": "Média",
    "Max": "Máx",
    "{name}: {area:.2f} m², uniformity {uniformity}": "{name}: {area:.2f} m², uniformidade {uniformity}",
    "{name} (back)": "{name} (verso)",
    "Mean {mean} {unit}, from {minimum} to {maximum}": "Média {mean} {unit}, de {minimum} a {maximum}",
    "Illuminance": "Iluminância",
    "not computed": "não calculado",
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
    "Which part of the light is shown": "Que parte da luz se mostra",
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
    "Mapping": "Distribuição",
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
    "Remove all results from the scene: attributes, colours, the fine faces and the tables": (
        "Remover todos os resultados da cena: atributos, cores, as faces finas e as tabelas"
    ),
    "Save the table of surfaces as a CSV file": "Salvar a tabela das superfícies em um arquivo CSV",
    "There are no results yet: solve first": "Ainda não há resultados: calcule antes",
    "The table could not be saved: {error}": "Não foi possível salvar a tabela: {error}",
    "Error": "Erro",
    "Estimate of what 95 of 100 faces' errors are below; of fronts only": (
        "Estimativa do valor abaixo do qual ficam os erros de 95 em 100 faces; só das frentes"
    ),
    "Unit": "Unidade",
    "What the colours stand for": "O que as cores representam",
    "Lux (lx)": "Lux (lx)",
    "DF (%)": "FLD (%)",
    "Daylight factor: share of what the whole sky, without Sun, gives an open horizontal plane": (
        "Fator de luz diurna: parcela do que o céu inteiro, sem Sol, dá a um plano horizontal desobstruído"
    ),
    "Colours": "Cores",
    "Scale, range and shading of the false colours, and their legend": (
        "Escala, intervalo e sombreamento das cores falsas, e sua legenda"
    ),
    "Lines of equal illuminance with their values": "Linhas de igual iluminância com seus valores",
    "Table of Surfaces": "Tabela das superfícies",
    "Minimum, mean, maximum and uniformity of each surface": (
        "Mínimo, média, máximo e uniformidade de cada superfície"
    ),
    "Daylight factor": "Fator de luz diurna",
    "Share of open sky": "Parcela do céu aberto",
    "Without a sky there is no daylight factor": "Sem céu não há fator de luz diurna",
    "Sunlight counts too: for daylight factors choose an overcast sky without Sun": (
        "A luz do Sol também conta: para fatores de luz diurna escolha um céu encoberto sem Sol"
    ),
    "Shading": "Sombreamento",
    "How colours lie on the faces": "Como as cores ficam nas faces",
    "Faces": "Faces",
    "Each face has the colour of its own mean": "Cada face tem a cor da sua própria média",
    "Smooth": "Suave",
    "Colours run from corner to corner, each the mean of the faces that meet there": (
        "As cores passam de canto a canto, cada um a média das faces que ali se encontram"
    ),
    "From (%)": "De (%)",
    "Daylight factor at the low end of the scale": "Fator de luz diurna no extremo inferior da escala",
    "To (%)": "Até (%)",
    "Daylight factor at the high end of the scale": "Fator de luz diurna no extremo superior da escala",
    "Iso-lux Lines": "Linhas isolux",
    "Draw lines of equal illuminance with their values": "Desenhar linhas de igual iluminância com seus valores",
    "Levels": "Níveis",
    "Values to draw lines for, such as 100, 200, 300, 500; empty for those of the legend": (
        "Valores das linhas, como 100, 200, 300, 500; vazio para os da legenda"
    ),
    "'{word}' is no illuminance: give numbers such as 100, 200, 300": (
        "'{word}' não é uma iluminância: informe números como 100, 200, 300"
    ),
    "In Renders": "Nas renderizações",
    "Have EEVEE and Cycles render the false colours: materials are overridden, tone mapping and the depth of field of "
    "cameras are off meanwhile": (
        "EEVEE e Cycles renderizam as cores falsas: enquanto isso os materiais são substituídos, e o mapeamento de "
        "tons e a profundidade de campo das câmeras ficam desligados"
    ),
    "Renders and Pictures": "Renderizações e imagens",
    "False colours and their legend in renders and pictures": "Cores falsas e sua legenda em renderizações e imagens",
    "Have the legend in renders of the false colours and in saved pictures": (
        "Incluir a legenda nas renderizações das cores falsas e nas imagens salvas"
    ),
    "Corner": "Canto",
    "Corner of the picture that the legend stands in": "Canto da imagem em que fica a legenda",
    "Bottom Left": "Embaixo à esquerda",
    "In the lower left corner of the picture": "No canto inferior esquerdo da imagem",
    "Bottom Right": "Embaixo à direita",
    "In the lower right corner of the picture": "No canto inferior direito da imagem",
    "Top Left": "Em cima à esquerda",
    "In the upper left corner of the picture": "No canto superior esquerdo da imagem",
    "Top Right": "Em cima à direita",
    "In the upper right corner of the picture": "No canto superior direito da imagem",
    "Size (%)": "Tamanho (%)",
    "Height of the legend, as a share of the picture's": "Altura da legenda, como parcela da altura da imagem",
    "Before Blender 5.0 EEVEE renders the colours of fine faces alone: show these, or use Cycles": (
        "Antes do Blender 5.0 o EEVEE só renderiza as cores das faces finas: mostre estas, ou use o Cycles"
    ),
    "Renders need a camera: Add > Camera": "Renderizações precisam de uma câmera: Adicionar > Câmera",
    "The legend needs a perspective or an orthographic camera": (
        "A legenda precisa de uma câmera em perspectiva ou ortográfica"
    ),
    "Solve again for the fine faces": "Calcule de novo para ter as faces finas",
}
