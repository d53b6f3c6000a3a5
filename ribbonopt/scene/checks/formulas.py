"""What is wrong with the parameters, formulas and equations of a scene; the values of the rest."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from keyword import iskeyword

from ribbonopt.scene.faults import KeyPath, Problem, dotted
from ribbonopt.scene.formulas.parsing import FormulaError, evaluate_value, parse_equation
from ribbonopt.scene.formulas.words import RESERVED
from ribbonopt.text import is_word

from .magnitudes import as_written


def values_of(
    formulas: Mapping[KeyPath, str], parameters: Mapping[str, float]
) -> tuple[dict[KeyPath, float], list[Problem]]:
    """Return the values of formulas by path, and a problem for each that has none."""
    values, problems = {}, []
    for path, formula in formulas.items():
        try:
            value = evaluate_value(formula, parameters)
        except FormulaError as error:
            problems.append(Problem(path, str(error)))
        else:
            values[path] = value
            problems += as_written(value, path)
    return values, problems


def check_parameters(parameters: Mapping[str, float]) -> Iterator[Problem]:
    """Yield the parameters that no formula could name."""
    for name in parameters:
        if not is_word(name) or iskeyword(name):
            message = "is no name; use letters, digits and _, with a letter first"
            yield Problem(("parameters", name), message)
        elif name in RESERVED:
            yield Problem(("parameters", name), "is a word of the formulas; choose another name")


def check_equations(equations: tuple[str, ...], parameters: Mapping[str, float]) -> list[Problem]:
    """Return the faults of `also`, where a formula is wrong or an equation stands twice."""
    problems = []
    first: dict[str, int] = {}
    for index, text in enumerate(equations):
        path: KeyPath = ("boundary", "also", index)
        try:
            parse_equation(text, parameters)
        except FormulaError as error:
            problems.append(Problem(path, str(error)))
        plain = "".join(text.split())
        if first.setdefault(plain, index) != index:
            before = dotted((*path[:-1], first[plain]))
            problems.append(Problem(path, f"says the same as {before}; keep one", repr(text)))
    return problems
