"""Site and time."""

from __future__ import annotations

OPERATORS = {
    "Set Place": "Definir lugar",
    "Now": "Agora",
    "Use a Sun Light": "Usar uma luz do Sol",
    "Add Place Preset": "Adicionar predefinição de lugar",
}

TEXTS = {
    "Site & Time": "Local e hora",
    "Place, date and hour": "Lugar, data e hora",
    "Sun: altitude {altitude:.1f}°, azimuth {azimuth:.1f}°": "Sol: altura {altitude:.1f}°, azimute {azimuth:.1f}°",
    "Sunrise {rise}, sunset {fall}": "Nasce às {rise}, põe-se às {fall}",
    "The Sun is below the horizon: only the sky is solved": "O Sol está abaixo do horizonte: só o céu é calculado",
    "The Sun neither rises nor sets": "O Sol não nasce nem se põe",
    "clock time": "hora legal",
    "solar time": "hora solar",
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
    "Time": "Horário",
    "What the hour means": "O que a hora significa",
    "Solar": "Solar",
    "At 12 the Sun stands highest": "Às 12 o Sol está no ponto mais alto",
    "Clock": "Legal",
    "Local clock time of the time zone": "Hora legal do fuso horário",
    "Hour": "Hora",
    "Hour of the day, with decimals: 9.5 is half past nine": "Hora do dia, com decimais: 9,5 são nove e meia",
    "Compass": "Bússola",
    "Draw north and the Sun in the 3D viewport, with results or while this tab is open": (
        "Desenhar o norte e o Sol na vista 3D, com resultados ou enquanto esta aba está aberta"
    ),
    "North Offset": "Desvio norte",
    "Angle in degrees from the +Y axis to true north, clockwise seen from above": (
        "Ângulo em graus do eixo +Y ao norte verdadeiro, no sentido horário visto de cima"
    ),
    "Days Later": "Dias depois",
    "Days to add to the date: keyframe it to run through months and years": (
        "Dias a somar à data: anime-os para percorrer meses e anos"
    ),
    "Sun Light": "Luz do Sol",
    "The Sun light of the scene, read or set": "A luz do Sol da cena, lida ou ajustada",
    "What the chosen Sun light of the scene has to do with the Sun of the calculation": (
        "O que a luz do Sol escolhida na cena tem a ver com o Sol do cálculo"
    ),
    "Apart": "À parte",
    "Nothing: the Sun follows from site, date and hour, and the light stays as it is": (
        "Nada: o Sol segue do local, da data e da hora, e a luz fica como está"
    ),
    "Read": "Ler",
    "The Sun stands where the light shines from, whatever site, date and hour say": (
        "O Sol está de onde a luz brilha, seja qual for o local, a data e a hora"
    ),
    "Set": "Ajustar",
    "The light is turned to where the Sun stands at the site, date and hour": (
        "A luz é girada para onde o Sol está no local, na data e na hora"
    ),
    "A light of type Sun": "Uma luz do tipo Sol",
    "There is no Sun light to read: choose one in Site & Time, or set Sun Light to Apart": (
        "Não há luz do Sol para ler: escolha uma em Local e hora, ou ponha Luz do Sol em À parte"
    ),
    "Places": "Lugares",
    "Cities, and places saved by the user": "Cidades, e lugares salvos pelo usuário",
    "Own presets": "Predefinições próprias",
    "Place": "Lugar",
    "Name of the city": "Nome da cidade",
    "There is no place '{name}' in the list: choose one of {known}": (
        "Não há o lugar '{name}' na lista: escolha um destes: {known}"
    ),
    "Set latitude, longitude and time zone (without summer time) to those of a city": (
        "Ajustar latitude, longitude e fuso (sem horário de verão) aos de uma cidade"
    ),
    "Set date, hour and time zone to those of this machine's clock": (
        "Ajustar data, hora e fuso aos do relógio deste computador"
    ),
    "Choose the scene's Sun light, a new one where there is none, and turn it to where the Sun stands": (
        "Escolher a luz do Sol da cena, uma nova se não houver, e girá-la para onde o Sol está"
    ),
    "Save or remove a preset: latitude, longitude, time zone and north offset": (
        "Salvar ou remover uma predefinição: latitude, longitude, fuso e desvio do norte"
    ),
}
