"""What the package offers by name: exactly this, found when first asked for."""

import re
from pathlib import Path

import pytest
from fresh import loaded_by, python

import ribbonopt
from ribbonopt import views

README = Path(__file__).parents[2] / "README.md"
PUBLIC = {
    *("Scene", "load_scene", "loads_scene", "dump_scene", "json_schema"),
    *("Solution", "prepare", "solve", "save_solution", "load_solution", "summarize"),
    *("Continuation", "load_branch", "load_study", "run_batch", "load_batch", "compare"),
    *("load", "Branch", "Batch", "Map", "export"),
    *("all_equilibria", "buckling_loads"),
    *("plot_ribbon", "plot_plane", "plot_strains", "save_figures"),
    "__version__",
}


def test_public_names_are_these() -> None:
    assert set(ribbonopt.__all__) == PUBLIC
    assert PUBLIC <= set(dir(ribbonopt))
    assert {name for name in dir(ribbonopt) if not name.startswith("__")} <= PUBLIC


@pytest.mark.parametrize("name", sorted(PUBLIC))
def test_public_names_exist(name: str) -> None:
    assert getattr(ribbonopt, name) is not None


@pytest.mark.parametrize("name", views.__all__)
def test_names_of_views_exist(name: str) -> None:
    assert callable(getattr(views, name))


def test_views_load_nothing_when_imported() -> None:
    assert not {"casadi", "numpy", "matplotlib"} & loaded_by("import ribbonopt.views")
    code = "from ribbonopt import plot_ribbon, save_figures"
    assert "matplotlib" not in loaded_by(code)


def test_examples_of_the_readme_use_public_names() -> None:
    blocks = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines() if "import" in line]
    found = [re.fullmatch(r"from ribbonopt import (.*)", line) for line in lines]
    names = [set(match[1].split(", ")) for match in found if match]
    assert len(blocks) == len(names) >= 1
    assert set().union(*names) <= PUBLIC
    assert not [line for line in lines if "ribbonopt." in line]


def test_other_names_do_not_exist() -> None:
    with pytest.raises(AttributeError, match="no attribute 'slove'"):
        _ = ribbonopt.slove


def test_solve_is_a_function_however_often_it_is_asked_for() -> None:
    done = python("import ribbonopt\n" + 2 * "assert callable(ribbonopt.solve)\n")
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    "first", ["ribbonopt.pipeline.prepared", "ribbonopt.cli", "ribbonopt.pipeline.check"]
)
def test_solve_is_a_function_whatever_was_imported_before(first: str) -> None:
    done = python(f"import {first}\nfrom ribbonopt import solve\nassert callable(solve)")
    assert done.returncode == 0, done.stderr
