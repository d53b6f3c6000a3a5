"""Rows of batches, as they are written: verified ones, failed ones, odd ones."""

from typing import Any

Row = dict[str, Any]


def good(number: int, **more: Any) -> Row:
    row = {
        "number": number,
        "scene": "s",
        "a": 0.1 * number,
        "b": number % 3,
        "status": "converged",
    }
    row |= {"verified": True, "message": "", "energy": number**2 / 7, "error": 10.0**-number}
    return row | {"u2": -number, "seconds": 0.01, "path": "newton"} | more


def bad(number: int, **more: Any) -> Row:
    row = {"number": number, "scene": "s", "a": 0.1 * number, "b": number % 3, "status": "crashed"}
    return row | {"verified": False, "message": f"died after {number}.5 s"} | more


ROWS = [good(1), bad(2), good(3), good(4), bad(5), good(6, error=None, energy=float("nan"))]

#: rows of any kind, by what they are
KINDS: dict[str, list[Row]] = {
    "none": [],
    "one": [good(1)],
    "one bad": [bad(1)],
    "all bad": [bad(1), bad(2)],
    "no energy": [good(1, energy=None), good(2, energy=None)],
    "words": [good(1, a="left"), good(2, a="right"), bad(3, a=[1, 2])],
    "truths": [good(1, a=True), good(2, a=False)],
    "powers": [good(i, a=10.0**i) for i in range(1, 6)],
}
