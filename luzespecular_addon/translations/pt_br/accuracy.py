"""How finely to calculate."""

from __future__ import annotations

OPERATORS = {
    "Add Accuracy Preset": "Adicionar predefinição de exatidão",
}

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
    "Accuracy": "Exatidão",
    "How finely to calculate": "Quão finamente calcular",
    "By Error": "Por erro",
    "As finely as it takes to keep below the error given here": (
        "Tão fino quanto preciso para ficar abaixo do erro informado aqui"
    ),
    "Error (%)": "Erro (%)",
    "Relative error that about 95 of 100 faces shall keep below": (
        "Erro relativo abaixo do qual devem ficar cerca de 95 de cada 100 faces"
    ),
    "Cycles": "Ciclos",
    "Diffuse reflections to follow: exactly so many; -1 for as many as the tolerance asks": (
        "Reflexões difusas a seguir: exatamente tantas; -1 para tantas quantas a tolerância pedir"
    ),
    "Tolerance": "Tolerância",
    "Reflections stop when what is left to come is below this share of the mean illuminance": (
        "As reflexões param quando o que falta é menor que esta parcela da iluminância média"
    ),
    "Specular Cut-off": "Corte especular",
    "Chains of mirrors and panes are followed down to this product of reflectances": (
        "Cadeias de espelhos e vidros são seguidas até este produto de refletâncias"
    ),
    "Threads": "Threads",
    "Threads of the solver; 0 for as many as the machine has cores": (
        "Linhas de execução do cálculo; 0 para tantas quantos os núcleos do computador"
    ),
    "Accuracies": "Exatidões",
    "Accuracies saved by the user": "Exatidões salvas pelo usuário",
    "Save or remove a preset: fineness and all numbers of the solver": (
        "Salvar ou remover uma predefinição: refinamento e todos os números do cálculo"
    ),
}
