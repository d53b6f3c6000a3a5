"""Scenes as YAML text that loads back to an equal scene."""

from __future__ import annotations

from dataclasses import MISSING, Field, fields, is_dataclass
from typing import Any

import yaml

from ribbonopt.errors import SceneError
from ribbonopt.scene.laws import OwnLaw
from ribbonopt.scene.model import Scene
from ribbonopt.scene.schema.annotations import key_of
from ribbonopt.scene.supports import SUPPORTS, Support

from .yamltext import scalar

_CORE = "tag:yaml.org,2002:"


def dump(scene: Scene) -> str:
    """Write a valid scene, leaving out the fields equal to their default (except every `type`).

    Raises
    ------
    SceneError
        If something of it is declared in Python.
    """
    if reason := unsayable(scene):
        raise SceneError(reason)
    text: str = yaml.dump(
        _plain(scene),
        Dumper=_Dumper,
        default_flow_style=None,
        sort_keys=False,
        allow_unicode=True,
        width=100,
    )
    return text


class _Dumper(yaml.SafeDumper):
    """Quotes every text that YAML 1.1, or 1.2 as this room reads it, takes for something else."""


def _write_text(dumper: yaml.SafeDumper, text: str) -> yaml.ScalarNode:
    style = None if isinstance(scalar(text), str) else "'"
    if not text.isprintable():
        style = '"'  # the only style that keeps every kind of line break
    return dumper.represent_scalar(_CORE + "str", text, style)


def _write_float(dumper: yaml.SafeDumper, value: float) -> yaml.ScalarNode:
    text = repr(value)
    if text.endswith(".0") and text != "-0.0":
        return dumper.represent_int(int(value))  # reads better as 0 than as 0.0
    # PyYAML would tag 1e-08 as a float or quote it as a text: in YAML 1.1 it is a text.
    return dumper.represent_scalar(_CORE + ("float" if "." in text else "str"), text)


_Dumper.add_representer(str, _write_text)
_Dumper.add_representer(float, _write_float)


def unsayable(scene: Scene) -> str:
    """Return why no file can say a scene: what of it is declared in Python; "" where one can."""
    for end in (scene.boundary.start, scene.boundary.end):
        if isinstance(end.support, Support) and SUPPORTS.get(end.support.name) != end.support:
            return (
                f"support {end.support.name!r} is declared in Python, which no file can say; name "
                f"one of {', '.join(SUPPORTS)}, or write the conditions of that end one by one"
            )
    if isinstance(scene.law, OwnLaw):
        return f"law {scene.law.type!r} is declared in Python, which no file can say"
    if scene.loads.own:
        kind = type(scene.loads.own[0]).__name__
        return f"loads.own: {kind} is declared in Python, which no file can say"
    return ""


def _plain(value: Any) -> Any:
    if isinstance(value, Support):
        return value.name
    if is_dataclass(value):
        kept = [member for member in fields(value) if _is_told(member, value)]
        if isinstance(value, Scene) and value.ribbon is not None:
            # Without an interval a file means all of such a ribbon.
            names = {member.name for member in kept} | {"interval"}
            kept = [member for member in fields(value) if member.name in names]
        return {key_of(member.name): _plain(getattr(value, member.name)) for member in kept}
    if isinstance(value, tuple):
        return [_plain(item) for item in value]
    return value


def _is_told(member: Field[Any], owner: Any) -> bool:
    default = member.default
    if member.default_factory is not MISSING:
        default = member.default_factory()
    return member.name == "type" or bool(getattr(owner, member.name) != default)
