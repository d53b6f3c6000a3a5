"""No module imports another in a circle, imports inside functions and for types included."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MODULES = {
    ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): path
    for path in (ROOT / "ribbonopt").rglob("*.py")
}


def imported(module: str) -> Iterator[str]:
    """Yield the modules of the package that one imports; a name's module, else its package."""
    package = module if MODULES[module].name == "__init__.py" else module.rpartition(".")[0]
    for node in ast.walk(ast.parse(MODULES[module].read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in MODULES)
        elif isinstance(node, ast.ImportFrom):
            base = package.split(".")[: len(package.split(".")) - node.level + 1]
            name = ".".join([*base, node.module or ""]).strip(".") if node.level else node.module
            for alias in node.names:
                full = f"{name}.{alias.name}"
                if full in MODULES or name in MODULES:
                    yield full if full in MODULES else str(name)


GRAPH = {module: set(imported(module)) - {module} for module in MODULES}


def reached(module: str) -> set[str]:
    """Return all modules that one imports, over others too."""
    found: set[str] = set()
    following = set(GRAPH[module])
    while following:
        found |= following
        following = set().union(*(GRAPH[other] for other in following)) - found
    return found


@pytest.mark.parametrize("room", ["transcription", "solvers", "solution", "accuracy", "problem"])
def test_no_module_imports_itself_over_others(room: str) -> None:
    # A package gathers what its modules offer, and its modules import one another directly.
    own = [name for name in MODULES if name.startswith(f"ribbonopt.{room}.")]
    assert own
    assert [name for name in own if name in reached(name)] == []
