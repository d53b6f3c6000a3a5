"""Numbers with bars in words: no digit is written that its bar leaves in doubt."""

from __future__ import annotations

import math

NOTHING = 1e-50  # what guards the laws where m = 0 leaves of zero
SMALL = 1e-3  # largest component of what is written with powers of ten


def upwards(error: float) -> str:
    """Write a bar with one digit, never smaller than it is."""
    if not 0 < error < math.inf:
        return f"{error:.0e}"
    unit = 10.0 ** math.floor(math.log10(error))
    return f"{math.ceil(error / unit * (1 - 1e-9)) * unit:.0e}"


def digits(value: float | None, error: float | None, small: bool = False) -> str:
    """Write a number, `small` ones with a power of ten, to the last digit that the error leaves."""
    if value is None:
        return "unknown"
    if error is None:
        return f"{value:.6g}" if abs(value) > NOTHING else "0"
    if abs(value) <= error:
        return "0"
    # Twice the bar, so that the last digit printed still stands after rounding.
    decimals = -math.ceil(math.log10(4 * error))
    if small:
        value = round(value, decimals)
        places = decimals + math.floor(math.log10(abs(value))) if value else 0
        return f"{value:.{min(15, places)}e}" if value else "0"
    text = f"{value:.{max(0, min(15, decimals))}f}"
    return "0" if float(text) == 0 else text
