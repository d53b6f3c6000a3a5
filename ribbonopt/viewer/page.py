"""One self-contained page: its parts, the scripts and the style it needs, and what it shows.

The page asks for nothing from outside, and its policy lets nothing run but the scripts that were
put in here, which the policy knows by their hashes: what a scene or a file says is shown and never
acts. The main script is deflated, as the rows are; `page/loader.js` unpacks both.
"""

from __future__ import annotations

import re
from typing import Any

from ribbonopt.text import marked_up

from .packing import deflated
from .parts import CHARTS, SCATTER, as_script, hash_of, joined, text_of
from .view import View, contents

PICTURE = ("colours.js", "camera.js", "mesh.js", "webgl.js", "painter.js")
RIBBON = ("overlay.js", "hand.js", "ribbon.js", "panels.js")
MORE: dict[str, tuple[str, ...]] = {
    "result": ("motion.js",),
    "branch": ("choice.js", "diagram.js"),
    "batch": SCATTER,
}
STYLES = ("colours.css", "page.css", "charts.css")
GENERATOR = "ribbonopt view"


def page_of(view: View) -> str:
    """Return the page of a view, HTML in one file."""
    return assembled(view.kind, view.name, contents(view))


def assembled(kind: str, name: str, data: dict[str, Any]) -> str:
    """Return the page of a kind with its data, `contents` of a view."""
    names = (*CHARTS, "data.js", *PICTURE, *RIBBON, *MORE[kind], "app.js")
    script = joined(names)
    loader, style = joined(("loader.js",)), joined(STYLES)
    allowed = f"script-src {hash_of(loader)} {hash_of(script)}; style-src {hash_of(style)}"
    parts = {
        "kind": kind,
        "title": marked_up(name),
        "policy": f"default-src 'none'; {allowed}",
        "style": style,
        "script": deflated(script.encode("utf-8")),
        "loader": loader,
        "about": marked_up(data.get("about", "")),
        "still": data.get("still", ""),
        "data": as_script(
            {key: value for key, value in data.items() if key not in ("still", "about")}
        ),
    }
    # In one pass: what a scene says may look like the name of a part.
    return re.sub(r"@(\w+)@", lambda found: parts.get(found[1], found[0]), text_of("page.html"))


def framed(page: str, height: int) -> str:
    """Return a page as a part of another, of a height in pixels: nothing of either meets."""
    return (
        f'<iframe srcdoc="{marked_up(page)}" sandbox="allow-scripts" title="ribbon" '
        f'style="width: 100%; height: {height}px; border: 0"></iframe>'
    )
