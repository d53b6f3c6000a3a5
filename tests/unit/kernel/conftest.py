"""The compiled kernel, for tests that hold for it alone."""

from types import ModuleType

import pytest

from ribbonopt.kernel import COMPILED, STATE


@pytest.fixture(scope="session")
def kernel() -> ModuleType:
    """Return the compiled module; where there is none the test says nothing."""
    if COMPILED is None:
        pytest.skip(f"of the compiled kernel, which is {STATE}")
    return COMPILED
