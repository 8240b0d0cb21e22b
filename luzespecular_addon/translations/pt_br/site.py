"""Site and time."""

from __future__ import annotations

TEXTS = {
    "Site & Time": "Local e hora",
    "Place, date and hour": "Lugar, data e hora",
    "Sun: altitude {altitude:.1f}°, azimuth {azimuth:.1f}°": "Sol: altura {altitude:.1f}°, azimute {azimuth:.1f}°",
    "Sunrise {rise}, sunset {fall}": "Nascer {rise}, pôr do sol {fall}",
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
