"""The page that all figures are drawn on: letters of any script, and no word of what is missing."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from io import BytesIO
from typing import Any

from matplotlib.backend_bases import RendererBase
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties, findfont, fontManager, get_font
from matplotlib.text import Text

from .paper_style import PLAIN, Style

NO_SCRIPTS = ("cm", "STIXNonUnicode", "STIXSize", "Last Resort", ".LastResort")  # begins of names
#: what makes files of two runs the same
UNDATED: dict[str, dict[str, Any]] = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}


class Page(Figure):
    """A figure that takes letters from other fonts where its own has none.

    It is drawn and written with the settings of its own style.
    """

    style: Style = PLAIN

    def draw(self, renderer: RendererBase) -> None:
        """Draw; what no font of this machine has stays an empty box."""
        with self.style.applied(), quiet():
            _complete(self)
            super().draw(renderer)

    def savefig(self, fname: Any, **keywords: Any) -> None:
        """Write a file, as `Figure.savefig` does, with text as text and without its date."""
        name = str(keywords.get("format") or fname)
        undated = next((date for end, date in UNDATED.items() if name.endswith(end)), None)
        if undated:
            keywords["metadata"] = undated | (keywords.get("metadata") or {})
        with self.style.applied(), quiet():
            super().savefig(fname, **keywords)

    def _repr_png_(self) -> bytes:
        """Return what a notebook shows, which knows by itself of figures of pyplot alone."""
        shown = BytesIO()
        self.savefig(shown, format="png")
        return shown.getvalue()


@contextmanager
def quiet() -> Iterator[None]:
    """Keep to ourselves which letters and weights fonts lack."""
    logs = [logging.getLogger(f"matplotlib.{part}") for part in ("font_manager", "mathtext")]
    levels = [log.level for log in logs]
    for log in logs:
        log.setLevel(logging.ERROR)
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message=r"Glyph .* missing from")
            yield
    finally:
        for log, level in zip(logs, levels, strict=True):
            log.setLevel(level)


def _complete(figure: Figure) -> None:
    """Add to each text the fonts that have what its own lack."""
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            axis.get_ticklabels()  # which are made only now
    for text in figure.findobj(Text):
        assert isinstance(text, Text)
        if not text.get_text().isascii():
            families = text.get_fontfamily()
            known = _letters(findfont(text.get_fontproperties()))
            lacking = {c for c in text.get_text() if c.isprintable() and ord(c) not in known}
            more = dict.fromkeys(filter(None, map(_family_with, sorted(lacking))))
            text.set_fontfamily([*families, *(name for name in more if name not in families)])


@cache
def _letters(path: str) -> frozenset[int]:
    return frozenset(get_font(path).get_charmap())


@cache
def _family_with(letter: str) -> str:
    """Return the family of a font of this machine that has a letter; "" if there is none."""
    for entry in sorted(fontManager.ttflist, key=lambda font: (font.style, str(font.weight))):
        if entry.name.startswith(NO_SCRIPTS):
            continue
        try:
            if ord(letter) not in _letters(entry.fname):
                continue
            path = findfont(FontProperties(family=[entry.name]), fallback_to_default=False)
            font = get_font(path)
            font.set_size(10.0, 72.0)
            if ord(letter) in _letters(path):
                font.load_char(ord(letter))  # pictures in place of outlines cannot be drawn
                return entry.name
        except (OSError, RuntimeError, ValueError):
            continue  # a font that matplotlib cannot read
    return ""
