"""One self-contained page: its parts, the scripts and the style it needs, and what it shows.

The page asks for nothing from outside, and its policy lets nothing run but the scripts that were
put in here, which the policy knows by their hashes: what a scene or a file says is shown and never
acts. The main script is deflated, as the rows are; `page/loader.js` unpacks both.
"""

from __future__ import annotations

import base64
import hashlib
import json
import re
from collections.abc import Iterable
from functools import cache
from importlib.resources import files
from typing import Any

from ribbonopt.text import marked_up

from .packing import deflated
from .view import View, contents

CHARTS = ("axes.js", "paths.js", "pointer.js", "cloud.js", "charts.js", "choice.js")
PICTURE = ("colours.js", "camera.js", "mesh.js", "webgl.js", "painter.js")
RIBBON = ("overlay.js", "hand.js", "ribbon.js", "panels.js")
MORE: dict[str, tuple[str, ...]] = {"result": (), "branch": ("diagram.js",), "batch": ()}
STYLES = ("page.css", "charts.css")
GENERATOR = "ribbonopt view"


def page_of(view: View) -> str:
    """Return the page of a view, HTML in one file."""
    return assembled(view.kind, view.name, contents(view))


def assembled(kind: str, name: str, data: dict[str, Any]) -> str:
    """Return the page of a kind with its data, `contents` of a view."""
    names = (*CHARTS, "data.js", *PICTURE, *RIBBON, *MORE[kind], "app.js")
    script = _joined(names)
    loader, style = _joined(("loader.js",)), _joined(STYLES)
    allowed = f"script-src {_hash(loader)} {_hash(script)}; style-src {_hash(style)}"
    parts = {
        "kind": kind,
        "title": marked_up(name),
        "policy": f"default-src 'none'; {allowed}",
        "style": style,
        "script": deflated(script.encode("utf-8")),
        "loader": loader,
        "data": as_script(data),
    }
    # In one pass: what a scene says may look like the name of a part.
    return re.sub(r"@(\w+)@", lambda found: parts.get(found[1], found[0]), _text("page.html"))


def as_script(data: Any) -> str:
    """Return data as JSON that ends no script before its time."""
    text = json.dumps(data, allow_nan=False, separators=(",", ":"))
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def framed(page: str, height: int) -> str:
    """Return a page as a part of another, of a height in pixels: nothing of either meets."""
    return (
        f'<iframe srcdoc="{marked_up(page)}" sandbox="allow-scripts" title="ribbon" '
        f'style="width: 100%; height: {height}px; border: 0"></iframe>'
    )


@cache
def _joined(names: Iterable[str]) -> str:
    """Return files one after the other, without remarks and indentation."""
    text = "\n".join(map(_text, names))
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    lines = (line.strip() for line in text.splitlines())
    return "\n".join(line for line in lines if line and not line.startswith("//"))


def _text(name: str) -> str:
    return (files("ribbonopt.viewer") / "page" / name).read_text(encoding="utf-8")


def _hash(text: str) -> str:
    digest = hashlib.sha256(text.encode("utf-8")).digest()
    return f"'sha256-{base64.b64encode(digest).decode('ascii')}'"
