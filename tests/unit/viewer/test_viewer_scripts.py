"""What shows ribbons in pages, run in a browser: the checks stand in JavaScript beside this."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from chromium import BROWSER, WANTED, Browser

from ribbonopt import load_scene, solve
from ribbonopt.viewer.looking import view_of
from ribbonopt.viewer.page import page_of
from ribbonopt.viewer.view import View

HERE = Path(__file__).parent
HALF = Path(__file__).parents[3] / "configs" / "moebius_half.yaml"
HOSTILE = "</script><b>bold</b><img src=x onerror='window.acted = 1'>"
CHECKS = (HERE / "viewer_checks.js").read_text(encoding="utf-8")
NAMES = re.findall(r'^  (?:async )?"([^"]+)"\(\) \{', CHECKS, re.MULTILINE)
pytestmark = pytest.mark.slow
READY = "document.documentElement.dataset.ready !== undefined"
RUN = """
return (async () => {
  const found = {};
  await frame();
  for (const [name, check] of Object.entries(checks)) {
    try { await check(); found[name] = ""; } catch (error) { found[name] = error.stack; }
  }
  return found;
})();
"""


def view() -> View:
    """Return a view of half a Moebius ribbon, and of the same once more, wider, as another."""
    found = view_of(solve(load_scene(HALF)), half_width=0.05)
    (ribbon,) = found.ribbons
    other = solve(load_scene(HALF, ["law={type: variational, delta: 0.3}"]))
    (more,) = view_of(other).ribbons
    return replace(found, ribbons=(replace(ribbon, warnings=(HOSTILE,)), more))


def columns(shown: View) -> dict[str, list[float]]:
    shape = shown.shapes[0]
    found = {name: getattr(shape, name) for name in ("s", "u2", "u3", "eta")}
    found |= dict(zip("xyz", shape.r.T, strict=True)) | {"width": shape.half_widths}
    for name, vectors in (("n", shape.n), ("m", shape.m)):
        for k, d in enumerate((shape.d1, shape.d2, shape.d3), start=1):
            found[f"{name}{k}"] = np.sum(vectors * d, axis=1)
    found |= {name: getattr(shape, name).ravel() for name in ("d1", "d2", "d3", "b")}
    return {name: values.tolist() for name, values in found.items()}


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    folder, shown = tmp_path_factory.mktemp("browser"), view()
    (folder / "page.html").write_text(page_of(shown), encoding="utf-8")
    with Browser(folder / "profile") as browser:
        browser.open(folder / "page.html", READY)
        assert browser.said == []
        results: dict[str, str] = browser.run(
            f"(() => {{ const given = {json.dumps(columns(shown))};\n{CHECKS}\n{RUN} }})()"
        )
        assert browser.said == []
    return results


@pytest.mark.skipif(not BROWSER and not WANTED, reason="no Chromium")
@pytest.mark.parametrize("name", NAMES)
def test_scripts(name: str, found: dict[str, str]) -> None:
    assert found[name] == ""


def test_each_check_is_known() -> None:
    assert len(NAMES) == len(set(NAMES)) == 13
