"""How finely to calculate."""

from __future__ import annotations

TEXTS = {
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
