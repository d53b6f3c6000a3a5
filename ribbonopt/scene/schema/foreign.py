"""Unknown keys that say what was meant: what the model does not have, or what stands elsewhere."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import is_dataclass
from typing import Any

from ribbonopt.scene.faults import KeyPath

from .annotations import branches, classes_of, hints, written_keys

#: what a user may look for and the model does not have, by the words for it
NOT_MODELLED = {
    ("contact", "friction", "collision"): "parts of the ribbon and its surroundings may overlap: "
    "there is no contact (where sides touch, a warning says so)",
    ("foundation", "spring", "springs", "adhesion"): "nothing elastic holds the ribbon: write what "
    "it does as loads (force, pressure) or supports",
    ("damping", "dynamics", "time", "velocity", "viscosity"): "equilibria only, and small "
    "vibrations about them: there is no time",
    ("mass",): "frequencies take that of the ribbon (ribbon.density); for a weight write gravity "
    "and ribbon.density, or loads.force",
    ("stretch", "extensible", "extensibility", "shear"): "the centre line neither stretches nor "
    "shears",
    ("temperature", "magnetic", "magnetization", "electric", "charge"): "elastic only; what it "
    "does may be written as natural strains or loads",
    ("plasticity", "yield", "yield_stress"): "elastic only",
}


def unmodelled(key: str) -> str:
    """Return why a key is of nothing that the model has; "" where it is not known to be."""
    for words, reason in NOT_MODELLED.items():
        if key in words:
            return f"is not in the model: {reason}; remove it"
    return ""


def elsewhere(key: str, path: KeyPath, root: type) -> str:
    """Return where a key belongs that is unknown at a path; "" where nothing of that name is.

    At the top of the class `root`, or, for a key found there, one level below.
    """
    if len(path) > 1:
        there = key in written_keys(root)
        return "unknown key here; it belongs at the top, under no other key" if there else ""
    places = [] if key == "type" else list(_below(key, root))
    return f"unknown key here; it belongs under {' or '.join(places)}" if places else ""


def _below(key: str, root: type) -> Iterator[str]:
    for name, annotation in hints(root).items():
        if any(key in written_keys(member) for member in _classes(annotation)):
            yield name


def _classes(annotation: Any) -> list[type]:
    if is_dataclass(annotation) and isinstance(annotation, type):
        return [annotation]
    return list(classes_of(annotation).values()) if branches(annotation) else []
