"""Numbers as the report writes them: no digit that the bar does not bear, no bar too small."""

import re

from hypothesis import given
from hypothesis import strategies as st

from ribbonopt.output.digits import digits as number
from ribbonopt.output.digits import upwards

errors = st.floats(1e-14, 1e3)
values = st.floats(1e-8, 1e8) | st.floats(-1e8, -1e-8)


@given(errors)
def test_a_bar_is_written_no_smaller_than_it_is(error: float) -> None:
    text = upwards(error)
    assert re.fullmatch(r"\de[+-]\d\d", text)
    assert error * (1 - 1e-8) <= float(text) <= 2 * error * (1 + 1e-8)


@given(values, errors)
def test_the_last_digit_stands_whatever_the_error_is(value: float, error: float) -> None:
    text = number(value, error, small=abs(value) < 1e-3)
    mantissa, _, power = text.partition("e")
    unit = 10.0 ** (int(power or 0) - len(mantissa.partition(".")[2]))
    if float(text) == 0:
        assert abs(value) <= 20 * error
        return
    assert abs(float(text) - value) <= 0.5000001 * unit
    # One digit in doubt may be written where it is before the point, or the last of 15.
    assert unit >= 2 * error or unit == 1.0
    assert unit <= 40 * error or abs(value) > 1e12 * error
