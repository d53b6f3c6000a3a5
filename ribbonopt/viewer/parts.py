"""Parts of pages: scripts and styles as they stand in a page, and data in a script."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from collections.abc import Iterable
from functools import cache
from importlib.resources import files

#: what draws charts, in an order in which each finds what it needs
CHARTS = ("axes.js", "paths.js", "frame.js", "pointer.js", "cloud.js", "charts.js")
SCATTER = ("choice.js", "scatter.js", "table.js", "batch.js")


@cache
def joined(names: Iterable[str]) -> str:
    """Return files of `page` one after the other, without remarks and indentation."""
    text = "\n".join(map(text_of, names))
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    lines = (line.strip() for line in text.splitlines())
    return "\n".join(line for line in lines if line and not line.startswith("//"))


def text_of(name: str) -> str:
    """Return a file of `page`."""
    return (files("ribbonopt.viewer") / "page" / name).read_text(encoding="utf-8")


def hash_of(text: str) -> str:
    """Return what a policy knows a script or a style by."""
    digest = hashlib.sha256(text.encode("utf-8")).digest()
    return f"'sha256-{base64.b64encode(digest).decode('ascii')}'"


def as_script(data: object) -> str:
    """Return data as JSON that ends no script before its time."""
    text = json.dumps(data, allow_nan=False, separators=(",", ":"))
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")
