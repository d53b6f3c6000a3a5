"""The house rules: who imports whom, who prints, and what a command does not load."""

import ast
import re
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import pytest
from fresh import loaded_by, python

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "ribbonopt"
FILES = sorted(PACKAGE.rglob("*.py"))
#: longest file that can be read at one sitting
LONGEST = 250


@cache
def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def layers() -> list[set[str]]:
    """Return the rooms of `pyproject.toml`, those that may import the most first."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    block = re.search(r'type = "layers"\nlayers = (\[.*?\n\])', text, re.DOTALL)
    assert block
    return [set(level.split(" | ")) for level in ast.literal_eval(block.group(1))]


def module_of(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imports_of(path: Path) -> Iterator[str]:
    """Yield full names of the modules that a file imports, in functions too."""
    module = module_of(path)
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package.split(".")[: len(package.split(".")) - node.level + 1]
            prefix = ".".join(base) if node.level else ""
            name = ".".join(part for part in (prefix, node.module) if part)
            yield name
            # `from ribbonopt import version` names a module by an alias.
            yield from (f"{name}.{alias.name}" for alias in node.names)


def level_of(module: str) -> int | None:
    for level, rooms in enumerate(layers()):
        if any(module == room or module.startswith(f"{room}.") for room in rooms):
            return level
    return None


def room_of(module: str) -> str:
    return ".".join(module.split(".")[:2])


def test_every_room_has_its_place() -> None:
    rooms = {room_of(module_of(path)) for path in FILES}
    placed = set().union(*layers())
    assert rooms - {"ribbonopt", "ribbonopt.__main__"} == placed


def test_rooms_import_only_rooms_above_them() -> None:
    upwards = []
    for path in FILES:
        module = module_of(path)
        own = level_of(module)
        if own is None:
            assert module in ("ribbonopt", "ribbonopt.__main__")
            continue
        for name in imports_of(path):
            level = level_of(name)
            if level is not None and room_of(name) != room_of(module) and level <= own:
                upwards.append(f"{module} imports {name}")
    assert upwards == []


@pytest.mark.parametrize("room", ["transcription", "solvers"])
def test_transcription_and_solvers_know_no_ribbons(room: str) -> None:
    ribbons = ("mechanics", "scene", "problem.ribbon", "problem.inverted")
    for path in (PACKAGE / room).rglob("*.py"):
        for name in imports_of(path):
            assert not name.startswith(tuple(f"ribbonopt.{r}" for r in ribbons)), path.name


def test_the_walk_of_continuation_knows_no_ribbons() -> None:
    own = "ribbonopt.studies.continuation.walk"
    paths = sorted((PACKAGE / "studies" / "continuation" / "walk").glob("*.py"))
    assert len(paths) > 8
    for path in paths:
        for name in imports_of(path):
            known = name.startswith((f"{own}.", "ribbonopt.arrays")) or name == own
            assert known or not name.startswith("ribbonopt"), f"{path.name} imports {name}"


def test_views_know_no_solver() -> None:
    for path in (PACKAGE / "views").rglob("*.py"):
        for name in imports_of(path):
            assert not name.startswith(("ribbonopt.solvers", "ribbonopt.transcription")), path.name


def calls_of(path: Path) -> Iterator[str]:
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            yield node.func.id


def those(wrong: Callable[[Path], object]) -> list[str]:
    """Return the files of the package of which something is true."""
    return [str(path.relative_to(PACKAGE)) for path in FILES if wrong(path)]


def test_only_the_command_line_prints() -> None:
    assert those(lambda p: p.parent.name != "cli" and "print" in set(calls_of(p))) == []


def test_nothing_is_evaluated_from_text() -> None:
    evaluating = {"eval", "exec", "compile", "__import__"}
    # Constructors are written from the names of fields, which stand in code.
    assert those(lambda p: evaluating & set(calls_of(p))) == ["classes.py"]


def test_files_are_short() -> None:
    assert those(lambda p: len(p.read_text(encoding="utf-8").splitlines()) > LONGEST) == []


def test_files_say_what_they_are_for() -> None:
    assert those(lambda p: not ast.get_docstring(tree_of(p))) == []


def swallows(path: Path) -> bool:
    """Whether a file catches everything, catches something and passes, or raises `Exception`."""
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.ExceptHandler):
            passes = len(node.body) == 1 and isinstance(node.body[0], ast.Pass)
            if node.type is None or passes:
                return True
        if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
            if getattr(node.exc.func, "id", "") == "Exception":
                return True
    return False


def test_no_error_is_swallowed() -> None:
    assert those(swallows) == []


def test_names_of_test_files_are_unique() -> None:
    """Two files of one name in folders that are no packages cannot be collected together."""
    names = [path.name for path in (ROOT / "tests").rglob("test_*.py")]
    assert sorted(name for name in set(names) if names.count(name) > 1) == []


def test_slow_tests_that_are_listed_exist(stale: list[str]) -> None:
    assert stale == []


def test_import_alone_is_light() -> None:
    heavy = {"casadi", "numpy", "matplotlib", "scipy", "yaml"}
    assert not heavy & loaded_by("import ribbonopt")


@pytest.mark.parametrize("scene", ["moebius_half", "helix"])
def test_solving_without_pictures_loads_no_more_than_it_needs(scene: str) -> None:
    path = str(ROOT / "configs" / f"{scene}.yaml")
    loaded = loaded_by(
        f"from ribbonopt.cli import main\nassert main(['solve', {path!r}, '--quiet']) == 0"
    )
    assert {"casadi", "numpy", "yaml"} <= loaded
    assert not {"matplotlib", "scipy"} & loaded


def test_solving_in_plain_numbers_loads_nothing_of_formulas_stages_and_starts() -> None:
    path = str(ROOT / "configs" / "moebius_half.yaml")
    code = f"from ribbonopt.cli import main\nassert main(['solve', {path!r}, '--quiet']) == 0"
    code += "\nimport sys\nprint(*sys.modules)"
    rooms = ("scene.formulas", "scene.stages", "scene.lens", "starts", "studies", "views")
    loaded = python(code).stdout.split()
    assert "ribbonopt.pipeline.prepared" in loaded
    assert [n for n in loaded if n.startswith(tuple(f"ribbonopt.{r}" for r in rooms))] == []


def test_bad_scenes_are_refused_without_casadi() -> None:
    loaded = loaded_by("from ribbonopt.cli import main\nassert main(['check', 'none.yaml']) == 2")
    assert not {"casadi", "matplotlib", "scipy"} & loaded


def test_scene_room_knows_no_casadi() -> None:
    assert "casadi" not in loaded_by("import ribbonopt.scene")
