"""Formulas: what they mean, what is refused, and that nothing of them ever runs."""

import math
import operator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ribbonopt.errors import SceneError
from ribbonopt.scene.formulas.expressions import Binary, Name, Number, Quantity, evaluate, parts
from ribbonopt.scene.formulas.numeric import NumericEnv
from ribbonopt.scene.formulas.parsing import (
    EquationFormula,
    FormulaError,
    evaluate_value,
    parse_equation,
    parse_expression,
    parse_value,
)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1 - turn", 0.75),
        ("2*3 + 4/8 - 1", 5.5),
        ("-2**2", -4.0),
        ("2**3**2", 512.0),
        ("2**-1", 0.5),
        ("+turn*8", 2.0),
        ("(1 + 2)*3", 9.0),
        ("sin(pi/2) + cos(pi) + tan(0)", 0.0),
        ("log(exp(2)) + sqrt(9) + abs(-1)", 6.0),
        ("dot([1, 2, 3], [4, 5, 6])", 32.0),
        ("cross(ex, ey).z", 1.0),
        ("cross([1, 2, 3], [4, 5, 6]).x", -3.0),
        ("cross([1, 2, 3], [4, 5, 6]).y", 6.0),
        ("norm(2*[3, 0, 4]/2 - ey*0)", 5.0),
        ("(ex + 2*ey - [0, 0, 3]).z", -3.0),
        ("(-[1, 2, 3]).y", -2.0),
        (" 1\n + 1 ", 2.0),
        (".5 + 1. + 1e-1", 1.6),
        ("180*deg - pi", 0.0),
        ("cos(60*deg)", 0.5),
    ],
)
def test_values(text: str, value: float) -> None:
    assert evaluate_value(text, {"turn": 0.25}) == pytest.approx(value, abs=1e-15)


def test_number_is_its_own_value() -> None:
    assert evaluate_value(3, {}) == 3.0


@pytest.mark.parametrize(
    "text", ["1/0", "sqrt(-1)", "log(0)", "(-8)**(1/3)", "9**9**9**9", "1e30**11", "exp(1e4)"]
)
def test_values_without_finite_real_value(text: str) -> None:
    with pytest.raises(FormulaError, match="no finite real value"):
        evaluate_value(text, {})


def test_equation_of_scalars() -> None:
    equation = parse_equation("dot(n, d1(start)) = 0")
    assert isinstance(equation, EquationFormula)
    assert equation.shape == "scalar"
    assert equation.text == "dot(n, d1(start)) = 0"
    quantities = [part for part in parts(equation.left) if isinstance(part, Quantity)]
    assert quantities == [Quantity("n", "start", "vector"), Quantity("d1", "start", "vector")]
    assert equation.right == Number(0.0, "c0")


def test_equation_of_vectors() -> None:
    equation = parse_equation("r(end) = [0, shift, 0]", ["shift"])
    assert equation.shape == "vector"
    assert Name("shift") in list(parts(equation.right))


def test_numbers_are_named_in_order_but_not_exponents() -> None:
    equation = parse_equation("2*u2(end)**2 + 3 = 4*pi**(1/2) + ex.x")
    numbers = [p for side in equation[:2] for p in parts(side) if isinstance(p, Number)]
    keyed = {part.key: part.value for part in numbers if part.key}
    assert keyed == {"c0": 2.0, "c1": 3.0, "c2": 4.0}
    assert sorted(p.value for p in numbers if not p.key) == [0, 0, 1, 1, 2, 2, math.pi]


@pytest.mark.parametrize(
    ("text", "column", "message"),
    [
        ("d1 = ex", 1, r"needs an end: d1\(start\) or d1\(end\)"),
        ("n1(end) = u2", 11, r"u2\(start\)"),
        ("d4(end) = ex", 1, "did you mean 'd"),
        ("n1(end) = trun", 11, "did you mean 'turn'"),
        ("dot(n, 3) = 0", 1, "dot takes 2 vectors; found vector, scalar"),
        ("sqrt(1, 2) = u2(end)", 1, "takes 1 scalar"),
        ("n*m(end) = 1", 1, r"dot\(a, b\)"),
        ("n + 1 = n", 1, "vector [+] scalar"),
        ("1/n = n", 1, "scalar / vector"),
        ("u2(end) = 2**n", 11, "scalar [*][*] vector"),
        ("n = 0", 3, r"write the zero vector as \[0, 0, 0\]"),
        ("1 = 1", None, "prescribes nothing"),
        ("u2(end) == 1", 9, "expected '='"),
        ("u2(end) = 1 = 2", None, "found 2 signs"),
        ("u2(end)", None, "found no '='"),
        ("u2(end) =", 10, "found nothing"),
        ("u2(end) = (1", 11, "cannot be read"),
        ("sin = u2(end)", 1, r"write sin\(...\)"),
        ("turn(end) = n1(end)", 1, "is no function"),
        ("deg(end) = n1(end)", 1, "is no function"),
        ("u2(end) = 3*degree", 13, "did you mean 'deg'"),
        ("n(middle) = n", 1, r"taken at \(start\) or \(end\)"),
        ("[1, 2] = n", 1, "three scalars"),
        ("u2(end).x = 1", 1, "only a vector has a component"),
        ("n.w = 1", 1, "no formula may hold"),
        ("u2(end)^2 = 1", 8, "a power is written [*][*]"),
        ("u2(end) = 5//2", 11, "operators are"),
        ("u2(end) = 1e999", 11, "too large"),
        ("u2(end) = " + "9" * 400, 11, "too large"),
        ("u2(end) = " + "-" * 60 + "1", None, "deeper than 50"),
        ("u2(end) = " + "1 + " * 200 + "1", None, "longer than 500"),
    ],
)
def test_refused_equations(text: str, column: int | None, message: str) -> None:
    with pytest.raises(FormulaError, match=message) as caught:
        parse_equation(text, ["turn"])
    if column is not None:
        assert f", column {column}:" in str(caught.value)
    assert isinstance(caught.value, SceneError)


@pytest.mark.parametrize("text", ["n", "d1(start)", "u2", "1 = 1", "", "ex", "other"])
def test_refused_values(text: str) -> None:
    with pytest.raises(FormulaError):
        parse_value(text, ["turn"])


def test_expression_in_plain_names() -> None:
    node = parse_expression("m2/m3 + dot(d1, ex)", {"m2": "scalar", "m3": "scalar", "d1": "vector"})
    assert isinstance(node, Binary)
    assert node.shape == "scalar"
    env = NumericEnv({"m2": 1.0, "m3": 4.0, "d1": NumericEnv({}).vector([5.0, 0.0, 0.0])})
    assert evaluate(node, env) == 5.25
    with pytest.raises(FormulaError, match="is no function"):
        parse_expression("m2(start)", {"m2": "scalar"})


def test_vector_expression_has_its_shape() -> None:
    assert parse_expression("2*d1", {"d1": "vector"}).shape == "vector"


ATTACKS = [
    "__import__('os').system('touch owned')",
    "__import__(pi)",
    "().__class__.__bases__[0]",
    "n.__class__ = 1",
    "ex.__class__",
    "(lambda: 1)()",
    "[x for x in ex]",
    "{1: 2}",
    "f'{1}'",
    "'a'*99999999",
    "ex[0]",
    "exec(1)",
    "sqrt(x=1)",
    "dot(*[ex, ey])",
    "(yield)",
    "(a := 1)",
    "1 if 1 else 2",
    "1 and 2",
    "not 1",
    "1 < 2",
    "True",
    "None",
    "...",
    "1j",
    "2turn",
    "1in ex",
    "ex.5in ex",
    "0x1F",
    "1_0",
    "1.x",
    "1e",
    "n.",
    ".",
    "b''",
    "1; 2",
    "1 # 2",
    "print(1)",
    "globals()",
    "\0",
    "\u0661 + 1",
    "await r",
]


@pytest.mark.parametrize("text", ATTACKS)
@pytest.mark.parametrize("as_equation", [True, False])
def test_attacks_are_refused(text: str, as_equation: bool) -> None:
    with pytest.raises(FormulaError):
        if as_equation:
            parse_equation(f"u2(end) = {text}")
        else:
            evaluate_value(text, {})


PIECES = ["n", "d1(end)", "pi", "ex", "1", "2.5", "**", "*", "-", "(", ")", "[", "]", ",", ".x"]
PIECES += ["in", "0x", "."]
PIECES += ["sqrt(", "dot(", "=", "__import__", "lambda", "for", "in", ":", "'", " ", "9**9", "//"]


@pytest.mark.filterwarnings("error")
@given(st.one_of(st.text(max_size=40), st.lists(st.sampled_from(PIECES)).map("".join)))
def test_random_text_is_a_formula_or_an_error(text: str) -> None:
    for parse in (parse_value, parse_equation, lambda text: evaluate_value(text, {})):
        try:
            parse(text)
        except FormulaError:
            pass


OPERATORS = {"+": operator.add, "-": operator.sub, "*": operator.mul}
numbers = st.floats(0, 1e3).map(lambda x: (repr(x), x))
trees = st.recursive(
    numbers,
    lambda inner: st.tuples(inner, st.sampled_from(sorted(OPERATORS)), inner).map(
        lambda t: (f"({t[0][0]} {t[1]} {t[2][0]})", OPERATORS[t[1]](t[0][1], t[2][1]))
    ),
    max_leaves=8,
)


@given(trees)
def test_arithmetic_agrees_with_the_operators(tree: tuple[str, float]) -> None:
    text, value = tree
    if len(text) <= 500 and math.isfinite(value):
        assert evaluate_value(text, {}) == value
