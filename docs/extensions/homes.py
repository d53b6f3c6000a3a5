"""Sphinx extension: a type in a signature leads to where it is told.

Signatures name classes by the modules where they are written, pages by those from which one imports
them. What is not public, or of another package, is a name without a link.
"""

from __future__ import annotations

from docutils.nodes import Element, Node
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment

ROOMS = ("ribbonopt", "ribbonopt.scene", "ribbonopt.errors")


def find(app: Sphinx, env: BuildEnvironment, node: Element, words: Node) -> Element | None:
    """Return the reference to a public class that is named by another module."""
    target = node.get("reftarget", "")
    if node.get("refdomain") != "py" or not target.startswith("ribbonopt."):
        return None
    domain, name = env.domains["py"], target.rpartition(".")[2]
    for room in ROOMS:
        public = f"{room}.{name}"
        if public in domain.objects:
            role = node["reftype"]
            return domain.resolve_xref(env, node["refdoc"], app.builder, role, public, node, words)
    return None


def setup(app: Sphinx) -> dict[str, bool]:
    """Register it."""
    app.connect("missing-reference", find)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
