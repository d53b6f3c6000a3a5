"""Radau collocation that begins at its first node: the mirror image of Radau IIA."""

from ribbonopt.transcription.tableaus import Tableau, radau


def left_radau(degree: int) -> Tableau:
    right = radau(degree)
    matrix = (right.weights - right.matrix)[::-1, ::-1]
    nodes, weights = 1 - right.nodes[::-1], right.weights[::-1]
    name = f"left radau {degree}"
    return Tableau(name, nodes, weights, matrix, right.order, False, left_radau)
