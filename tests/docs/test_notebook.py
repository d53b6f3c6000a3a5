"""The notebook of the documentation, run as a user would: each cell, in a kernel of its own."""

from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbclient import NotebookClient

DOCS = Path(__file__).parents[2] / "docs"
ENERGY = 28.7247515569  # of half of the ribbon, from 28-digit Taylor series: tests/paper


@pytest.mark.slow
def test_the_notebook_runs_and_shows_what_it_says(tmp_path: Path) -> None:
    notebook = nbformat.read(DOCS / "notebooks" / "first.ipynb", as_version=4)
    nbformat.validate(notebook)
    assert not any(cell.get("outputs") for cell in notebook.cells), "stored without outputs"
    NotebookClient(notebook, timeout=120, resources={"metadata": {"path": tmp_path}}).execute()
    shown = [last_of(cell) for cell in notebook.cells if cell.cell_type == "code"]
    energy, bar = map(float, shown[1]["text/plain"].strip("()").split(", "))
    assert abs(energy - ENERGY) < 1e-9
    assert 0 < bar < 1e-8
    assert "verified" in shown[0]["text/plain"]
    assert all("image/png" in shown[i] for i in (2, 3))
    assert all("<table" in shown[i]["text/html"] for i in (4, 5))
    assert list(tmp_path.iterdir()) == []


def last_of(cell: Any) -> dict[str, str]:
    """What a cell shows; an error ends the run before."""
    return dict(cell.outputs[-1].data)


def test_a_figure_shows_itself_without_pyplot() -> None:
    from ribbonopt.views.page import Page

    page = Page(figsize=(1, 1), dpi=50)
    page.text(0.5, 0.5, "ä")
    assert page._repr_png_()[:8] == b"\x89PNG\r\n\x1a\n"
