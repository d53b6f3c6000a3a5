"""The gallery: each scene and study of `configs/`, solved and drawn when the pages are built.

A page for each, with its picture, what it is and where its truth is from, the report, and its text.
What was solved is kept in `docs/_build/scenes` until the scene or the package changes.
"""

from __future__ import annotations

import hashlib
import os
import shutil
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

from drawn import Drawn, draw
from pieces import code, fenced, page

ROOT = Path(__file__).parents[2]
CONFIGS = ROOT / "configs"
KEPT = ROOT / "docs" / "_build" / "scenes"
HEAD = "# yaml-language-server"
WORDS = """\
Every scene and every study that comes with ribbonopt, solved as this page was built. Behind each
picture: what the scene is and where its truth is from, the command, the report, and the scene.
"""
GROUPS = {
    "": "Scenes",
    "paper": "Scenes of the paper's figures",
    "shear": "The sheared arch",
    "maps": "Maps of two numbers",
    "studies": "Studies",
}


def pages(folder: Path) -> dict[str, str]:
    """Return the gallery and the page of each scene; pictures are written beside them."""
    paths = sorted(path.relative_to(CONFIGS) for path in CONFIGS.rglob("*.yaml"))
    with ProcessPoolExecutor(mp_context=get_context("spawn"), max_workers=os.cpu_count()) as pool:
        drawn = dict(zip(paths, pool.map(_kept, paths, [_source()] * len(paths)), strict=True))
    (folder / "scenes").mkdir(parents=True, exist_ok=True)
    made = {f"scenes/{_name(path)}.md": _page(path, drawn[path]) for path in paths}
    for path in paths:
        _copied(drawn[path].picture, folder / "scenes" / f"{_name(path)}.png")
    sections = [
        _section(group, [p for p in paths if p.parts[:-1] == ((group,) if group else ())])
        for group in GROUPS
    ]
    assert sum(text.count("figure}") for text in sections) == len(paths), "a folder has no group"
    hidden = "```{toctree}\n:hidden:\n\n" + "\n".join(f"scenes/{_name(p)}" for p in paths) + "\n```"
    return {"gallery.md": page("# Gallery", WORDS, *sections, hidden)} | made


def _name(path: Path) -> str:
    return "-".join(path.with_suffix("").parts)


def _source() -> str:
    """Return what tells this state of the package from others."""
    found = hashlib.sha256()
    for path in sorted((ROOT / "ribbonopt").rglob("*.py")):
        found.update(path.read_bytes())
    return found.hexdigest()


def _kept(path: Path, source: str) -> Drawn:
    text = (CONFIGS / path).read_text(encoding="utf-8")
    digest = hashlib.sha256(f"{source} {text}".encode()).hexdigest()[:20]
    folder = KEPT / f"{_name(path)}-{digest}"
    if not (folder / "report.txt").exists():
        for old in KEPT.glob(f"{_name(path)}-{'?' * 20}"):
            shutil.rmtree(old)
        folder.mkdir(parents=True)
        draw(CONFIGS / path, folder)
    return Drawn.of(folder)


def _copied(found: Path, to: Path) -> None:
    if not to.exists() or to.read_bytes() != found.read_bytes():
        shutil.copyfile(found, to)


def _section(group: str, paths: list[Path]) -> str:
    figures = [
        f"```{{figure}} scenes/{_name(path)}.png\n:target: scenes/{_name(path)}.html\n"
        f":alt: the ribbon of {path.as_posix()}\n\n{code(path.stem)}\n```"
        for path in paths
    ]
    return page(f"## {GROUPS[group]}", "::::{container} scenes", *figures, "::::")


def _page(path: Path, drawn: Drawn) -> str:
    lines = (CONFIGS / path).read_text(encoding="utf-8").splitlines()
    head = [line for line in lines if line.startswith("#")]
    first = next(i for i, line in enumerate(lines) if not line.startswith("#"))
    says = "\n".join(line[1:].removeprefix(" ") for line in head if not line.startswith(HEAD))
    shown = f"configs/{path.as_posix()}"
    verb = "batch" if drawn.study else "solve"
    return page(
        f"# {code(path.with_suffix('').as_posix())}",
        f"```{{image}} {_name(path)}.png\n:alt: the ribbon of {shown}\n:class: scene\n```",
        "The picture shows the first ribbon of the study." if drawn.study else "",
        f"```{{code-block}} text\n:class: says\n\n{says}\n```",
        fenced(f"ribbonopt {verb} {shown} --plot", "sh"),
        fenced(f"ribbonopt continue {shown} --plot", "sh") if drawn.continued else "",
        fenced(f"ribbonopt map {shown}", "sh") if drawn.mapped else "",
        fenced(drawn.report),
        fenced("\n".join(lines[first:]), "yaml"),
    )
