"""Pages open without a network, ask for nothing, complain of nothing, fit, and can be read."""

from typing import Any

import pytest
from pages import HOSTILE, Pages
from tab import NARROW, WIDE, Tab
from truth import PAPER, inked, ribbon

from ribbonopt.text import printable

KINDS = ["moebius_half", "moebius_whole", "branch", "batch", "report", "equilibria"]
ODD = ["failed", "hostile", "point", "moebius_kirchhoff", "lateral_buckling_si", "three_supports"]
#: contrast that texts need (WCAG 2 AA), whatever their size
CONTRAST = 4.5
#: texts that are seen, with their colour and the nearest background below; those of charts too
TEXTS = """(() => {
  const found = [];
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walk.nextNode(); node; node = walk.nextNode()) {
    const element = node.parentElement, style = getComputedStyle(element);
    if (!node.textContent.trim() || !element.checkVisibility()) continue;
    if (/^(SCRIPT|STYLE|NOSCRIPT|OPTION|TITLE|title)$/.test(element.tagName)) continue;
    const colour = element instanceof SVGElement ? style.fill : style.color;
    let below = element, back = "rgba(0, 0, 0, 0)";
    while (below && /, 0\\)$/.test(back)) {
      back = getComputedStyle(below).backgroundColor;
      below = below.parentElement;
    }
    found.push([node.textContent.trim().slice(0, 40), colour, back]);
  }
  return found;
})()"""
REPORT_READY = 'document.querySelector(".chart svg text") ? 0 : Promise.reject("no chart")'
#: elements wider than the window that nobody can scroll to
CUT = """[...document.querySelectorAll("main *, header *")].filter((one) => {
  const box = one.getBoundingClientRect();
  if (!box.width || one.closest(".scroll, svg, canvas")) return false;
  return box.right > innerWidth + 1 || box.left < -1;
}).map((one) => one.outerHTML.slice(0, 100))"""


def ready(tab: Tab, pages: Pages, name: str, size: tuple[int, int] = WIDE) -> None:
    if name == "report":
        tab.open(pages.file(name), size, ready=REPORT_READY)
    else:
        tab.open(pages.file(name), size)


def luminance(colour: str) -> float:
    parts = [float(x) / 255 for x in colour[colour.index("(") + 1 : -1].split(",")[:3]]
    linear = [x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(colour: str, back: str) -> float:
    low, high = sorted(map(luminance, (colour, back)))
    return (high + 0.05) / (low + 0.05)


def test_a_page_opens(tab: Tab, pages: Pages) -> None:
    """The one quick test: a ribbon is seen, and nothing went wrong."""
    ready(tab, pages, "moebius_half")
    assert tab.faults() == []
    assert 0.03 < inked(ribbon(tab)).mean() < 0.8
    assert tab.run("!!document.createElement('canvas').getContext('webgl2')") is True


@pytest.mark.slow
@pytest.mark.parametrize("name", [*KINDS, *ODD])
def test_it_asks_for_nothing_and_complains_of_nothing(tab: Tab, pages: Pages, name: str) -> None:
    for size in (WIDE, NARROW):
        ready(tab, pages, name, size)
        assert tab.faults() == [], size
        wide, tall = tab.run(
            "[document.documentElement.scrollWidth, document.documentElement.scrollHeight]"
        )
        assert wide <= size[0], "it scrolls sideways"
        assert tab.run(CUT) == [], size
        reached = tab.run(f"(scrollTo(0, {tall}), scrollY + innerHeight)")
        assert reached >= tall - 1
        assert tab.run('document.querySelectorAll(".chart svg text").length') > 4
    assert tab.run("typeof acted") == "undefined"


@pytest.mark.slow
def test_what_a_scene_says_is_text(tab: Tab, pages: Pages) -> None:
    ready(tab, pages, "hostile")
    said = printable(HOSTILE)
    assert tab.run('document.querySelector("h1").textContent') == said
    assert tab.run("document.title") == said
    assert tab.run('document.querySelector("#caption").textContent') == f"{said}; {said}"
    assert tab.run('document.querySelector("#facts dt").textContent') == said
    assert tab.run('document.querySelectorAll("img, body b b").length') == 0
    assert tab.faults() == []


@pytest.mark.slow
@pytest.mark.parametrize("name", ["moebius_half", "branch", "batch", "report"])
def test_light_and_dark_can_be_read(tab: Tab, pages: Pages, name: str) -> None:
    ready(tab, pages, name)
    for dark in (False, True):
        body = tab.run("getComputedStyle(document.body).backgroundColor")
        assert body == "rgb({}, {}, {})".format(*PAPER[dark])
        assert tuple(tab.pixels()[-3, 3]) == PAPER[dark]
        weak = [
            (text, colour, back, round(contrast(colour, back), 2))
            for text, colour, back in tab.run(TEXTS)
            if contrast(colour, back) < CONTRAST
        ]
        assert weak == []
        tab.press("#theme")
    assert tab.run("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"
    assert tab.faults() == []


@pytest.mark.slow
def test_it_is_dark_where_the_system_is(tab: Tab, pages: Pages) -> None:
    if tab.name != "chromium":
        pytest.skip("Firefox cannot be told by BiDi what its system likes")

    def system(likes: str) -> None:
        session = tab.bidi.call("goog:cdp.getSession", {"context": tab.context})["session"]
        features = [{"name": "prefers-color-scheme", "value": likes}]
        given: dict[str, Any] = {"method": "Emulation.setEmulatedMedia", "session": session}
        tab.bidi.call("goog:cdp.sendCommand", {**given, "params": {"features": features}})

    system("dark")
    try:
        ready(tab, pages, "moebius_half")
        assert tuple(tab.pixels()[-3, 3]) == PAPER[True]
        assert tuple(ribbon(tab)[3, 3]) == PAPER[True]
        dark = inked(ribbon(tab), dark=True)
        system("light")
        tab.settle()
        assert tuple(ribbon(tab)[3, 3]) == PAPER[False]
        assert (dark != inked(ribbon(tab))).mean() < 0.03  # the same ribbon
    finally:
        system("")


@pytest.mark.slow
@pytest.mark.parametrize("name", ["moebius_half", "branch", "batch", "report"])
def test_it_is_printed_light(tab: Tab, pages: Pages, name: str) -> None:
    ready(tab, pages, name)
    tab.press("#theme")
    before = tab.pixels()
    data = tab.bidi.call("browsingContext.print", {"context": tab.context})["data"]
    assert len(data) > 20_000
    assert (tab.pixels() == before).mean() > 0.99  # and is as it was
    assert tab.faults() == []
