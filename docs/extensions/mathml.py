"""Sphinx extension: formulas as MathML, which browsers draw by themselves, without any script.

Pages can be read offline, and hold no program of others for it. The translation is that of
docutils; a formula that it does not know is a warning, so that the strict build fails.
"""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from docutils.utils.math import MathError, latex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging

LOG = logging.getLogger(__name__)
#: sizes of parentheses, which are left to the browser
SIZED = re.compile(r"\\(?:big|Big|bigg|Bigg)[lrm]?(?![a-zA-Z])")
#: fractions of two digits without braces, which docutils takes for one number
SHORT = re.compile(r"(\\[td]?frac)(\d)(\d)")
#: operators that browsers would put blanks around: primes, and bars of sizes
TIGHT = {
    "<mo>'</mo>": '<mo form="postfix" lspace="0" rspace="0">\u2032</mo>',
    '<mo class="mathopen">|</mo>': '<mo lspace="0" rspace="0" stretchy="false">|</mo>',
    "<mo>|</mo>": '<mo lspace="0" rspace="0" stretchy="false">|</mo>',
}


def mathml(node: nodes.Element, block: bool) -> str:
    """Return the MathML of a formula; its TeX, where that cannot be translated."""
    tex = node.astext()
    plain = SHORT.sub(r"\1{\2}{\3}", SIZED.sub("", tex))
    try:
        found = str(latex2mathml.tex2mathml(plain, as_block=block))
    except MathError as error:
        LOG.warning("formula %r: %s", tex, error, location=node, type="mathml")
        return nodes.Text(tex).astext().replace("&", "&amp;").replace("<", "&lt;")
    for loose, tight in TIGHT.items():
        found = found.replace(loose, tight)
    return found


def inline(translator: Any, node: nodes.math) -> None:
    """Write a formula in a line."""
    translator.body.append(mathml(node, block=False))
    raise nodes.SkipNode


def display(translator: Any, node: nodes.math_block) -> None:
    """Write a formula on a line of its own; a wide one is scrolled, not the page."""
    translator.body.append(f'<div class="formula">{mathml(node, block=True)}</div>\n')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the renderer."""
    app.add_html_math_renderer("mathml", (inline, None), (display, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
