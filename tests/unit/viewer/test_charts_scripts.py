"""What draws charts in pages, run in a browser: the checks stand in JavaScript beside this."""

import json
import os
import re
import shutil
import subprocess
from html import unescape
from pathlib import Path
from typing import Any

import pytest
from batch_rows import bad, good

from ribbonopt.viewer.diagram import diagram_of
from ribbonopt.viewer.parts import CHARTS, SCATTER, as_script, joined
from ribbonopt.viewer.rows import table_of
from ribbonopt.views.branch_rows import BranchFigure

HERE = Path(__file__).parent
CHECKS = ("charts_checks.js", "batch_checks.js")
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
BROWSER = next(filter(None, map(shutil.which, BROWSERS)), "")
WANTED = os.environ.get("RIBBONOPT_BROWSERS") == "on"  # a missing one is a failure
HOSTILE = "</script><b>bold</b><img src=x onerror='window.acted = 1'>"
RUN = """
const found = {};
for (const [name, check] of Object.entries(checks)) {
  found[name] = "";
  try { check(); } catch (error) { found[name] = `${error.message} ${error.stack}`; }
}
document.body.replaceChildren();
document.body.textContent = "[[" + JSON.stringify(found) + "]]";
"""
NAMES = [
    name
    for file in CHECKS
    for name in re.findall(r'^  "([^"]+)"\(\) \{', (HERE / file).read_text(), re.MULTILINE)
]


def point(number: int, p: float, energy: float, branch: int = 0, **more: Any) -> dict[str, Any]:
    found = {"number": number, "stage": 0, "branch": branch, "parameter": "law.p", "law.p": p}
    found |= {"kind": "point", "negative": 0, "note": "", "error": 10.0 ** (number - 12)}
    return found | {"energy": energy, "u2": p * p, "origin": None} | more


def given() -> dict[str, object]:
    branch = [
        point(0, 0.0, 1.0),
        point(1, 1.0, 2.0),
        point(2, 2.0, 4.0, kind="branch point", negative=None),
        point(3, 3.0, 6.0, negative=1),
        point(4, 3.5, 6.5, negative=1),
        point(5, 2.5, 3.0, branch=1, origin=2),
        point(6, 3.0, 2.5, branch=1, kind="kink"),
        point(7, 4.0, 2.6, branch=1),
    ]
    mirrored = [point(i, i, 0.0) for i in range(3)]
    mirrored += [point(3 + i, 2 + i, i * i, branch=1, origin=2) for i in range(1, 9)]
    mirrored += [point(11 + i, 2 + i, i * i, branch=2, origin=2) for i in range(1, 9)]
    later = [
        {**point(i, 4.0, 2.6 + i, branch=1, stage=1), "parameter": "law.q", "law.q": 0.1 * i}
        for i in range(8, 20)
    ]
    rows = [
        good(i, word=("left", "right")[i % 2], error=10.0 ** -(1 + i % 9))
        if i % 50
        else bad(i, energy=None, word="left")
        for i in range(1, 251)
    ]
    hostile = [good(1, word=HOSTILE), bad(2, message=HOSTILE, word="w", status=HOSTILE)]
    hostile[0]["<b>column</b>"] = 1.0
    return {
        "branch": diagram_of(BranchFigure(branch, (("value", "energy"),))),
        "stages": diagram_of(BranchFigure([*branch, *later], (("value", "energy"),))),
        "mirrored": diagram_of(BranchFigure(mirrored, (("value", "energy"),))),
        "none": diagram_of(BranchFigure([], ())),
        "empty": table_of([], ()),
        "batch": table_of(rows, ("a", "word")),
        "hostile": table_of(hostile, ("word", "<b>column</b>")),
    }


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    folder = tmp_path_factory.mktemp("browser")
    scripts = joined((*CHARTS, *SCATTER, "diagram.js"))
    checks = "\n".join((HERE / file).read_text() for file in CHECKS)
    style = joined(("colours.css", "charts.css"))
    (folder / "page.html").write_text(
        f"<!DOCTYPE html><meta charset=utf-8><style>{style}</style><body><script>{scripts}\n"
        f"const given = {as_script(given())};\n{checks}\n{RUN}</script>",
        encoding="utf-8",
    )
    options = ["--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1500,900"]
    command = [BROWSER, *options, f"--user-data-dir={folder / 'profile'}", "--dump-dom"]
    url = (folder / "page.html").as_uri()
    done = subprocess.run([*command, url], capture_output=True, text=True, timeout=60, check=True)
    said = re.search(r"\[\[(.*)\]\]", unescape(done.stdout), re.DOTALL)
    assert said, done.stdout[-2000:] + done.stderr[-2000:]
    results: dict[str, str] = json.loads(said.group(1))
    return results


@pytest.mark.skipif(not BROWSER and not WANTED, reason="no Chromium")
@pytest.mark.parametrize("name", NAMES)
def test_scripts(name: str, found: dict[str, str]) -> None:
    assert found[name] == ""


def test_each_check_is_known() -> None:
    assert len(NAMES) == len(set(NAMES)) == 24
