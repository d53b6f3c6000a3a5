"""YAML text to plain data: the scalars of YAML 1.2, and texts that are no data."""

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ribbonopt.scene.text.yamltext import YamlTextError, read


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e-2", 0.01),
        ("1e-8", 1e-8),
        ("1E+3", 1e3),
        (".5", 0.5),
        ("+1.", 1.0),
        ("-.5e1", -5.0),
        ("685.230_15e+03", "685.230_15e+03"),
        ("+.inf", math.inf),
        ("-.INF", -math.inf),
        ("10", 10),
        ("-3", -3),
        ("010", 10),
        ("0o14", 12),
        ("0x1F", 31),
        ("0b1", "0b1"),
        ("0x_1", "0x_1"),
        ("0x", "0x"),
        ("+-1", "+-1"),
        ("e5", "e5"),
        ("1e", "1e"),
        (".", "."),
        ("+", "+"),
        ("\u0661", "\u0661"),
        ("1" + "0" * 400, math.inf),
        ("1_000", "1_000"),
        ("1:30", "1:30"),
        ("1e-2x", "1e-2x"),
        ("yes", "yes"),
        ("no", "no"),
        ("on", "on"),
        ("Off", "Off"),
        ("y", "y"),
        ("true", True),
        ("FALSE", False),
        ("tRue", "tRue"),
        ("null", None),
        ("~", None),
        ("", None),
        ("2001-12-14", "2001-12-14"),
        ("<<", "<<"),
        ("'1'", "1"),
        ('"true"', "true"),
        ("!!str 1", "1"),
        ("'null'", "null"),
    ],
)
def test_scalars_of_yaml_1_2(text: str, value: Any) -> None:
    data = read(f"key: {text}").data["key"]
    assert data == value
    assert type(data) is type(value)


def test_nan_is_a_number() -> None:
    assert math.isnan(read(".nan").data)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_every_repr_of_a_float_is_read_exactly(number: float) -> None:
    value = read(f"[{number!r}, {number:e}, {number:.17G}]").data
    assert [float(item) for item in value] == [number, float(f"{number:e}"), number]
    assert isinstance(value[1], float)


def test_aliases_are_copies() -> None:
    data = read("a: &v [1, {b: 2}]\nc: *v").data
    assert data["a"] == data["c"] == [1, {"b": 2}]
    assert data["a"] is not data["c"]
    assert data["a"][1] is not data["c"][1]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: &a [*a]", "repeats itself"),
        ("[&a 1, &a [*a]]", "repeats itself"),
        ("a: *b", "alias"),
        ("[" * 60 + "]" * 60, "nests too deeply"),
        # libyaml, which reads ahead, may have a limit of its own.
        ("[" * 100_000, "nests too deeply|nesting depth"),
        ("{a: " * 100_000, "nests too deeply|nesting depth"),
        ("{a: 1, a: " * 100_000, "nests too deeply|nesting depth"),
        ("--- a\n--- b", "second document"),
        ("a: b: c", "mapping values are not allowed"),
        ("a:\n\t- b", "indent with spaces"),
        ("a: \0", "not YAML"),
        ("a: \ud800", "not YAML"),
        ("a: 'b", "not YAML"),
    ],
)
def test_texts_that_are_no_plain_data(text: str, message: str) -> None:
    with pytest.raises(YamlTextError, match=message):
        read(text)


def test_alias_bombs_are_refused() -> None:
    rows = ["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    rows += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 12)]
    with pytest.raises(YamlTextError, match="too many values"):
        read("\n".join(rows))
