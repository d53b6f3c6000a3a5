"""No module imports, by whatever way round, one that imports it: not in functions either."""

import ast
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def module_of(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


FILES = {module_of(path): path for path in sorted((ROOT / "ribbonopt").rglob("*.py"))}


def at_run_time(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a tree, but what stands under `if TYPE_CHECKING`."""
    yield node
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.If) and ast.unparse(child.test).endswith("TYPE_CHECKING"):
            for other in child.orelse:
                yield from at_run_time(other)
        else:
            yield from at_run_time(child)


def imports_of(module: str, text: str) -> set[str]:
    """Return the modules of the package that one imports; a package stands for its __init__."""
    is_package = FILES[module].name == "__init__.py"
    package = (module if is_package else module.rpartition(".")[0]).split(".")
    found: set[str] = set()
    for node in at_run_time(ast.parse(text)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            source = ".".join([*base, *([node.module] if node.module else [])])
            for alias in node.names:
                inner = f"{source}.{alias.name}"
                found.add(inner if inner in FILES else source)
    return {name for name in found if name in FILES and name != module}


def cycles(graph: dict[str, set[str]]) -> list[list[str]]:
    """Return cycles of a graph, one for each part of it that hangs together by them."""
    graph, found = dict(graph), []
    while True:
        try:
            TopologicalSorter(graph).prepare()
        except CycleError as error:
            *cycle, _ = error.args[1]
            found.append(sorted(cycle))
            graph[cycle[0]] = graph[cycle[0]] - set(cycle)
            graph[cycle[1]] = graph[cycle[1]] - set(cycle)
        else:
            return found


def test_no_module_imports_itself_in_a_circle() -> None:
    texts = {module: path.read_text(encoding="utf-8") for module, path in FILES.items()}
    assert not cycles({module: imports_of(module, text) for module, text in texts.items()})


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("def f():\n    from .model import Scene", {"ribbonopt.scene.model"}),
        (
            "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from .model import Scene",
            set(),
        ),
        ("from ribbonopt import version", {"ribbonopt.version"}),
        ("from . import model, Scene", {"ribbonopt.scene.model", "ribbonopt.scene"}),
        ("import ribbonopt.errors", {"ribbonopt.errors"}),
        ("import numpy", set()),
    ],
)
def test_imports_are_found(text: str, expected: set[str]) -> None:
    assert imports_of("ribbonopt.scene.ends", text) == expected


def test_cycles_are_found() -> None:
    graph = {"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a", "e"}, "e": {"d"}, "f": {"a"}}
    assert sorted(cycles(graph)) == [["a", "b", "c"], ["d", "e"]]
