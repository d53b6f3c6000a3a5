"""Warnings that our code causes are errors in tests; those of other packages fail nothing.

A warning belongs to the module at whose line it points: `stacklevel` decides. What a package does
inside points at itself, what a caller should not do (a name that will go) points at the caller.
"""

import types
import warnings

import numpy as np
import pytest

KINDS = [DeprecationWarning, PendingDeprecationWarning, FutureWarning, UserWarning, SyntaxWarning]
OTHERS = ["casadi.casadi", "matplotlib._api", "distributed.client", "numpy", "dask"]
OURS = ["ribbonopt", "ribbonopt.scene.model", "test_warnings", "conftest", "analytic", "my_rod"]

each_kind = pytest.mark.parametrize("kind", KINDS)


def module(name: str, code: str, **names: object) -> types.ModuleType:
    """Return a module of that name, as warnings see it."""
    made = types.ModuleType(name)
    vars(made).update(names, warnings=warnings)
    exec(code, vars(made))
    return made


def package(name: str, kind: type[Warning]) -> types.ModuleType:
    """Return a module that warns of itself (`inside`) and of its caller (`old`)."""
    return module(
        name,
        "def inside(): warnings.warn('within', kind)\n"
        "def old(): warnings.warn('use new()', kind, stacklevel=2)",
        kind=kind,
    )


@each_kind
@pytest.mark.parametrize("name", OTHERS)
def test_what_another_package_does_inside_fails_nothing(name: str, kind: type[Warning]) -> None:
    with warnings.catch_warnings(record=True) as told:
        module("ribbonopt.caller", "def call(): inside()", inside=package(name, kind).inside).call()
    assert [str(warning.message) for warning in told] == ["within"]


@each_kind
@pytest.mark.parametrize("name", OURS)
def test_what_our_call_causes_is_an_error(name: str, kind: type[Warning]) -> None:
    caller = module(name, "def call(): old()", old=package("matplotlib.figure", kind).old)
    with pytest.raises(kind, match="use new"):
        caller.call()


def test_names_that_begin_as_ours_are_those_of_others() -> None:
    with warnings.catch_warnings(record=True) as told:
        package("ribbonoptics", DeprecationWarning).inside()
    assert len(told) == 1


def test_numbers_that_are_none_are_errors_wherever_they_arise() -> None:
    other = module("scipy.other", "def divide(): return one / zero", one=np.ones(1), zero=[0.0])
    with pytest.raises(RuntimeWarning, match="divide by zero"):
        other.divide()
