"""Pages as text: self-contained, of some size, and nothing that a scene says acts in them."""

import base64
import hashlib
import html
import json
import re
import zlib
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import pytest

from ribbonopt import load_scene, solve
from ribbonopt.solution.solution import Solution
from ribbonopt.viewer import embedded
from ribbonopt.viewer.branches import caption_of, chosen_of, left_out
from ribbonopt.viewer.looking import view_of
from ribbonopt.viewer.page import MORE, assembled, page_of
from ribbonopt.viewer.view import contents

CONFIGS = Path(__file__).parents[3] / "configs"
KILO = 1000
HOSTILE = "</script><script>alert(1)</script><!-- & \"'\u202e\x1b[31m @data@ 環"


@cache
def solved(name: str) -> Solution:
    return solve(load_scene(CONFIGS / f"{name}.yaml"))


@cache
def page() -> str:
    return page_of(view_of(solved("moebius_half")))


def data_of(text: str) -> dict:
    (found,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', text, re.S)
    return json.loads(found)


def script_of(text: str) -> str:
    (found,) = re.findall(r'<script type="text/plain" id="script">(.*?)</script>', text, re.S)
    return zlib.decompress(base64.b64decode(found)).decode()


def hash_of(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def test_its_policy_allows_its_own_scripts_and_style_and_nothing_else() -> None:
    (policy,) = re.findall(r'http-equiv="Content-Security-Policy" content="(.*?)"', page())
    (style,) = re.findall(r"<style>(.*?)</style>", page(), re.S)
    (loader,) = re.findall(r"<script>(.*?)</script>", page(), re.S)
    rules = dict(rule.split(" ", 1) for rule in policy.split("; "))
    assert rules.pop("default-src") == "'none'"
    assert set(rules.pop("script-src").split()) == {hash_of(loader), hash_of(script_of(page()))}
    assert rules.pop("style-src") == hash_of(style)
    assert rules == {}


def test_it_asks_for_nothing_from_outside() -> None:
    assert not re.findall(r'\s(?:src|href)="', page())
    assert not re.findall(r"url\(|@import|fetch\(|XMLHttpRequest|WebSocket", script_of(page()))
    addresses = set(re.findall(r"https?://[^\"'\s]+", page() + script_of(page())))
    assert addresses <= {"http://www.w3.org/2000/svg"}  # a name, not a place


@pytest.mark.parametrize("kind", MORE)
def test_without_data_it_is_fifty_kilobytes(kind: str) -> None:
    assert len(assembled(kind, "", {}).encode()) < 50 * KILO


@pytest.mark.parametrize("name", ["moebius_half", "lateral_buckling_si", "edgewise_clamp"])
def test_a_ribbon_adds_ten_kilobytes(name: str) -> None:
    text = page_of(view_of(solved(name)))
    assert len(text.encode()) - len(assembled("result", "", {}).encode()) < 10 * KILO


def test_a_name_that_looks_like_a_page_is_text() -> None:
    view = view_of(solved("moebius_half"))
    ribbon = replace(view.ribbons[0], caption=HOSTILE, warnings=(HOSTILE,))
    text = page_of(replace(view, name=HOSTILE, about=HOSTILE, ribbons=(ribbon,)))
    assert text.count("</script>") == page().count("</script>")
    assert "alert(1)</" not in text
    assert "\x1b" not in text
    assert "\u202e" not in text
    told = data_of(text)
    assert told["name"] == told["shapes"][0]["caption"] == told["shapes"][0]["warnings"][0]
    assert told["name"].startswith("</script><script>alert(1)</script><!-- & \"'\\u202e\\x1b[31m")
    assert told["name"].endswith("環")


def test_what_is_said_of_a_ribbon() -> None:
    solution = solved("moebius_half")
    told = data_of(page())
    (shape,) = told["shapes"]
    assert (told["kind"], told["name"], told["allowed"]) == ("result", "moebius-half", True)
    assert (shape["verified"], shape["closing"], shape["rod"]) == (True, -1, False)
    assert 0.45 * shape["count"] < shape["solved"] < 0.55 * shape["count"]
    numbers = dict(shape["numbers"])
    energy, _, bar = numbers["energy"].partition(" ± ")
    assert abs(float(energy) - solution.energy) <= float(bar) + 1e-10 < 1e-6
    assert numbers["half twists"] == "1"


def test_units_of_si() -> None:
    told = contents(view_of(solved("lateral_buckling_si")))
    assert told["units"]["force"] == "N"
    assert dict(told["shapes"][0]["numbers"])["energy"].split()[1] == "J"
    assert dict(told["shapes"][0]["numbers"])["longest arrows"].endswith(" N/m")
    # Its weight hangs along -z, everywhere alike: arrows of one length.
    arrows = [arrow for arrow in told["shapes"][0]["acting"] if arrow["kind"] == "density"]
    assert len(arrows) > 10
    assert all(arrow["way"] == pytest.approx([0, 0, -1]) for arrow in arrows)


def test_a_rod_has_no_plane_of_strains() -> None:
    view = view_of(solved("edgewise_clamp"))
    assert contents(view)["shapes"][0]["rod"] is False  # it has generatrices, and u1 too
    (ribbon,) = view.ribbons
    rod = replace(ribbon, subject=replace(ribbon.subject, rod=True))
    assert contents(replace(view, ribbons=(rod,)))["shapes"][0]["rod"] is True


def test_all_of_it_is_in_the_first_view() -> None:
    view = view_of(solved("moebius_half"))
    frame, (shape,) = contents(view)["camera"], view.shapes
    for side in (-1.0, 1.0):
        from_middle = (shape.points(side) - frame["centre"]) @ list(
            zip(*frame["axes"], strict=True)
        )
        assert (abs(from_middle[:, :2]) <= frame["extent"]).all()
        assert (abs(from_middle[:, 2]) <= frame["depth"]).all()
    assert max(frame["extent"]) < 0.5  # it is a band of length 1


def test_the_width_that_is_asked_for() -> None:
    view = view_of(solved("moebius_half"), half_width=0.07)
    assert view.shapes[0].half_width == 0.07
    assert "half-width 0.07" in view.about


def test_a_page_in_a_notebook_stands_for_itself() -> None:
    text = embedded(solved("moebius_half"))
    (inner,) = re.findall(r'^<iframe srcdoc="([^"]*)" sandbox="allow-scripts" ', text)
    assert html.unescape(inner) == page()


def test_of_long_branches_special_points_and_some_evenly_between() -> None:
    special = {37: "fold", 38: "kink", 701: "branch point"}
    rows = [{"kind": special.get(i, "point")} for i in range(1000)]
    chosen = chosen_of(rows)
    assert len(chosen) == 400
    assert chosen == sorted(set(chosen))
    assert {0, 999, *special} <= set(chosen)
    assert max(b - a for a, b in pairwise(chosen)) <= 4
    assert chosen_of(rows[:400]) == list(range(400))
    folds = [{"kind": "fold"}] * 1000
    assert len(chosen_of(folds)) == 400
    (told,) = left_out(1000, 400, "points")
    assert told.startswith("the shapes of 600 of 1000 points")
    assert left_out(400, 400, "points") == ()


@pytest.mark.parametrize(
    ("negative", "words"),
    [(0, "stable"), (1, "unstable, 1 direction"), (2, "unstable, 2 directions")],
)
def test_stability_in_words(negative: int, words: str) -> None:
    row = {"number": 3, "kind": "point", "parameter": "law.epsilon", "law.epsilon": 0.25}
    assert caption_of(row | {"negative": negative}) == f"point 3: epsilon = 0.25, {words}"
    assert caption_of(row | {"negative": None}).endswith("stability not known")
    fold = row | {"negative": None, "kind": "fold"}  # where stability changes
    assert caption_of(fold) == "point 3: fold, epsilon = 0.25"
