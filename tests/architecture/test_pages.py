"""The pages of the docs say what is so: links lead somewhere, commands parse, scenes are scenes."""

import ast
import re
import shlex
import shutil
from functools import cache
from pathlib import Path

import pytest
import yaml

import ribbonopt
from ribbonopt.cli.arguments import VERBS, parser
from ribbonopt.scene import Scene
from ribbonopt.scene.schema.annotations import written_keys
from ribbonopt.scene.yamlio import loads_scene
from ribbonopt.solvers import Status
from ribbonopt.studies.batch.sweep import load_study

ROOT = Path(__file__).parents[2]
MADE = {"verification.md"}  # by a command, as long as it must be
PAGES = [path for path in sorted((ROOT / "docs").glob("*.md")) if path.name not in MADE]
README = ROOT / "README.md"
each_page = pytest.mark.parametrize("page", [README, *PAGES], ids=lambda path: path.stem)
KEYS = {*written_keys(Scene)}
#: what a part of a scene on a page is put into
BASE = """
name: base
law: {type: sadowsky}
parameters: {distance: 0.9, turn: 0, angle: 0}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0, distance], directors: {turns: [{y: turn*deg}]}}
"""
SIZES = {"length": 1, "width": 0.01, "thickness": 1e-4, "youngs_modulus": 4.5e9}
SIZES |= {"poisson_ratio": 0.3, "density": 1000}
#: statuses that are not those of a solve, by the call or the name that says them
SAYING = {"ConvergenceError", "_fail", "indeterminate"}
NAMED = {"NOT_REACHED", "DOUBTFUL", "LOST", "AGAIN"}


def text_of(page: Path) -> str:
    return page.read_text(encoding="utf-8")


def blocks(page: Path, language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", text_of(page), re.DOTALL | re.MULTILINE)


def commands(page: Path) -> list[str]:
    """Lines of code that call ribbonopt, and commands in the text that are no mere names."""
    text = re.sub(r"\\\n\s*", "", text_of(page))
    lines = re.findall(r"^(?: {4}|\t)?(?:\$ )?(ribbonopt .*)$", text, re.MULTILINE)
    inline = re.findall(r"`(ribbonopt (?:[a-z]+) [^`]+)`", text)
    return [command for command in [*lines, *inline] if command.split()[1] in VERBS]


def anchors(page: Path) -> set[str]:
    """Names of the headings of a page, as GitHub and MyST make them."""
    lines = re.findall(r"^#+ (.*)$", text_of(page), re.MULTILINE)
    plain = [re.sub(r"[^\w\- ]", "", line.lower()) for line in lines]
    return {line.strip().replace(" ", "-") for line in plain}


@each_page
def test_links_lead_somewhere(page: Path) -> None:
    links = re.findall(r"\]\(([^)\s]+)\)", text_of(page))
    for link in (link for link in links if "://" not in link):
        name, _, anchor = link.partition("#")
        target = (page.parent / name).resolve() if name else page
        if "generated" in Path(name).parts:  # when pages are built, which then fails without
            continue
        assert target.exists(), f"{page.name}: {link}"
        if anchor and target.suffix == ".md":
            assert anchor in anchors(target), f"{page.name}: {link}"


@each_page
def test_files_that_are_named_exist(page: Path) -> None:
    folders = "ribbonopt|tests|scripts|configs|docs"
    for path in re.findall(rf"`((?:{folders})/[^`\s*]*)`", text_of(page)):
        assert (ROOT / path).exists() or "NAME" in path, f"{page.name}: {path}"


@each_page
def test_commands_are_commands(page: Path) -> None:
    for command in commands(page):
        words = shlex.split(command, comments=True)[1:]
        words = words[: next((i for i, word in enumerate(words) if word in ("&&", ">")), None)]
        try:
            parser(words).parse_args(words)
        except SystemExit as end:  # `--help` and the like end too, by zero
            assert not end.code, f"{page.name}: {command}"


@each_page
def test_files_of_commands_exist(page: Path) -> None:
    for command in commands(page):
        for word in shlex.split(command, comments=True):
            if word.startswith("configs/") and "*" not in word:
                assert (ROOT / word).exists(), f"{page.name}: {command}"


@each_page
def test_scenes_and_studies_can_be_read(page: Path, tmp_path: Path) -> None:
    for number, block in enumerate(blocks(page, "yaml")):
        if not block.startswith("name:"):
            continue
        if "\nsweep:" in block:
            place = ROOT / "configs" / f".of-{page.stem}-{number}.yaml"
            scene = re.search(r"^scene: ([\w./]+)", block, re.MULTILINE)
            assert scene
            there = ROOT / "configs" / Path(scene[1]).name
            file = tmp_path / place.name
            file.write_text(block.replace(scene[1], str(there)), encoding="utf-8")
            study = load_study([file])
            study.check()
            assert study.count > 1
        else:
            loads_scene(block, page.name)


@each_page
def test_parts_of_scenes_are_parts_of_scenes(page: Path) -> None:
    for block in blocks(page, "yaml"):
        part = yaml.safe_load(block)
        if block.startswith("name:") or not isinstance(part, dict) or not part.keys() <= KEYS:
            continue
        whole = yaml.safe_load(BASE)
        parameters = {"parameters": whole["parameters"] | part.get("parameters", {})}
        whole |= ({"ribbon": SIZES} if "gravity" in part else {}) | part | parameters
        loads_scene(yaml.safe_dump(whole, sort_keys=False), page.name)


@each_page
def test_python_uses_public_names(page: Path) -> None:
    if page.name == "extending.md":  # whose code is tested as it stands
        return
    for block in blocks(page, "python"):
        for node in ast.walk(ast.parse(block)):
            if isinstance(node, ast.ImportFrom) and node.module == "ribbonopt":
                assert {name.name for name in node.names} <= set(ribbonopt.__all__), block


#: whose Python stands by itself, block by block; others have tests of their own
ALONE = ("batches", "bifurcations", "commands", "start")
WITH_PYTHON = [README, *(ROOT / "docs" / f"{name}.md" for name in ALONE)]


@pytest.mark.slow
@pytest.mark.parametrize("page", WITH_PYTHON, ids=lambda path: path.stem)
def test_python_runs(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copytree(ROOT / "configs", tmp_path / "configs")
    study = tmp_path / "configs" / "studies" / "arches.yaml"
    text = study.read_text(encoding="utf-8")
    study.write_text(re.sub(r"count: \d+", "count: 2", text), encoding="utf-8")  # 4 of 500
    saved = ribbonopt.solve(ribbonopt.load_scene("configs/moebius_half.yaml"))
    folder = tmp_path / "results" / "moebius-half"
    folder.mkdir(parents=True)
    ribbonopt.save_solution(saved, folder)
    for block in blocks(page, "python"):
        exec(compile(block, str(page), "exec"), {})


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.stem)
def test_pages_are_short(page: Path) -> None:
    assert len(text_of(page).splitlines()) <= 250


@cache
def statuses() -> set[str]:
    """Every word that the code gives as a status."""
    found = {status.name.lower() for status in Status}
    for path in (ROOT / "ribbonopt").rglob("*.py"):
        room = path.relative_to(ROOT / "ribbonopt").parts
        if {"stress", "comparison", "laws", "verification"} & set(
            room
        ):  # words of their own tables
            continue
        for node in ast.walk(ast.parse(text_of(path))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") in SAYING:
                values = [*node.args[1:], *(k.value for k in node.keywords if k.arg == "status")]
            elif isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") in NAMED:
                values = node.value.elts if isinstance(node.value, ast.Tuple) else [node.value]
            else:
                continue
            words = [v.value for v in values if isinstance(v, ast.Constant)]
            found |= {word for word in words if isinstance(word, str)}
    return found


def test_every_status_is_on_the_page_of_messages() -> None:
    rows = re.findall(r"^\| (`.*?) \|", text_of(ROOT / "docs" / "messages.md"), re.MULTILINE)
    listed = {word for row in rows for word in re.findall(r"`([a-z_]+)`", row)}
    known = statuses()
    assert len(known) > len(Status) + 5  # those outside the enumeration were found
    assert known - listed == set()


def test_no_status_is_on_the_page_that_nothing_says() -> None:
    text = text_of(ROOT / "docs" / "messages.md").partition("## Status of a solve")[2]
    text = text.partition("## How a branch ends")[0]
    rows = re.findall(r"^\| (`.*?) \|", text, re.MULTILINE)
    listed = {word for row in rows for word in re.findall(r"`([a-z_]+)`", row)}
    assert listed - statuses() - {"some_failed"} == set()  # of a whole batch, in its JSON


def test_every_command_is_on_the_page_of_commands() -> None:
    text = text_of(ROOT / "docs" / "commands.md")
    assert [verb for verb in VERBS if f"| `ribbonopt {verb}" not in text] == []


def test_every_failed_folder_is_on_the_page_of_messages() -> None:
    text = text_of(ROOT / "docs" / "messages.md")
    for failure in {status.failure for status in Status} - {""}:
        assert f"`DIR.{failure}`" in text
