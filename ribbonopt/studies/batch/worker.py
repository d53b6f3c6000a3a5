"""A worker of a batch: reads chunks as lines of JSON, writes a line for each ribbon.

A process of its own (`begin.py`), so that a ribbon that hangs or crashes takes nothing with it.
What is built for a structure is kept for the ribbons to come.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from ribbonopt.errors import ModelError, RibbonoptError
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.plain import Row, finite
from ribbonopt.problem import Posed
from ribbonopt.scene import Scene
from ribbonopt.scene.document import Document
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.recorded import error_of, numbers_of, sampled

from .family import Family, solve_beside

WATCH = 2.0  # seconds between two looks whether the batch is still there


class Worker:
    """Solves chunks; keeps what it has built."""

    def __init__(self) -> None:
        """Begin with nothing read and nothing built."""
        self._built: dict[tuple[object, ...], Prepared] = {}
        self._document: Document | None = None
        self._posed: Posed | None = None

    def answers(self, chunk: dict[str, Any]) -> Iterator[dict[str, Any]]:
        """Yield for every ribbon that it begins, and its row; those of `skip` are passed over."""
        before: Family | None = None
        for ribbon in chunk["ribbons"]:
            known = ribbon["number"] in chunk["known"]
            if ribbon["number"] in chunk["skip"] or (known and ribbon["followed"]):
                continue
            yield {"at": ribbon["number"]}
            if ribbon["task"]:
                yield {"row": self._other(ribbon, chunk)}
                continue
            if ribbon["followed"]:
                yield {"row": self._followed(ribbon, chunk)}
                continue
            row, found, family = self._solved(ribbon, before)
            before = family or before
            if ribbon["number"] not in chunk["known"]:
                try:
                    _save(chunk, ribbon, row, found)
                except OSError as error:  # the row, which may still find room, says it
                    row["message"] += f"{row['message'] and '; '}full solution not kept: {error}"
                yield {"row": row}

    def _solved(
        self, ribbon: dict[str, Any], before: Family | None
    ) -> tuple[Row, Solution | None, Family | None]:
        """Return row and solution of a ribbon, and what the next one may start from."""
        found, family = None, None

        def solve(scene: Scene, row: Row) -> None:
            nonlocal found, family
            posed, number = self._pose(scene), ribbon["number"]
            found, start, family = solve_beside(self._of(posed), posed, number, before)
            row |= _outcome(found, start)
            row |= _recorded(found, row)

        return self._row(ribbon, solve), found, family

    def _followed(self, ribbon: dict[str, Any], chunk: dict[str, Any]) -> Row:
        """Return the row of a ribbon that is continued."""
        from .branches import follow  # few studies ask for it

        def answer(scene: Scene, row: Row) -> None:
            place = _place(chunk, ribbon)
            row |= follow(scene, self._prepared, chunk["save"], place, 2 * WATCH)

        return self._row(ribbon, answer)

    def _other(self, ribbon: dict[str, Any], chunk: dict[str, Any]) -> Row:
        """Return the row of a ribbon to which something else is done."""
        from ribbonopt.studies.maps.tasks import TASKS, Place  # only maps ask for it

        def answer(scene: Scene, row: Row) -> None:
            place = Place(Path(chunk["folder"]), ribbon["place"], 2 * WATCH)
            row |= TASKS[ribbon["task"]](scene, self._prepared, place, ribbon["inputs"])

        return self._row(ribbon, answer)

    def _prepared(self, scene: Scene) -> Prepared:
        return self._of(Posed.of(scene))

    def _pose(self, scene: Scene) -> Posed:
        """Return a scene posed: what it shares with the one before is not evaluated again."""
        before = self._posed
        self._posed = Posed.of(scene) if before is None else before.moved(scene)
        return self._posed

    def _of(self, posed: Posed) -> Prepared:
        """Return the structure of a scene, built once."""
        structure = posed.structure
        if structure not in self._built:
            self._built[structure] = prepare(replace(posed.given, continuation=None, map=None))
        return self._built[structure]

    def _row(self, ribbon: dict[str, Any], answer: Callable[[Scene, Row], None]) -> Row:
        """Return the row of a ribbon, to which `answer` adds, or which says why that failed."""
        started = time.perf_counter()
        row: Row = {"number": ribbon["number"], "scene": ribbon["source"], **ribbon["inputs"]}
        try:
            scene = self._scene(ribbon)
            row["scene"] = scene.name
            answer(scene, row)
        except RibbonoptError as error:
            status = getattr(error, "status", "bad_input")
            row |= {"status": status, "verified": False, "message": str(error)}
        except Exception as error:  # whatever it is, the other ribbons go on
            message = f"{type(error).__name__}: {error}"
            row |= {"status": "error", "verified": False, "message": message}
        row["seconds"] = time.perf_counter() - started
        return finite(row)  # type: ignore[no-any-return]

    def _scene(self, ribbon: dict[str, Any]) -> Scene:
        """Return the scene of a ribbon; a text is read once for those that follow one another."""
        text = ribbon["text"], ribbon["source"]
        if self._document is None or (self._document.text, self._document.source) != text:
            self._document = Document(*text)
        return self._document.scene(ribbon["set"])


def _outcome(found: Solution, start: str) -> Row:
    row: Row = {
        "status": found.status.name.lower(),
        "verified": found.verified,
        "message": "" if found.verified else found.message,
    }
    if found.status.converged:
        row |= numbers_of(found) | {"error": error_of(found)}
        if found.scene.starts > 1 or found.scene.equilibria is not None:
            row["equilibria"] = 1 + len(found.others)
    steps = [step["step"] for step in found.steps]
    row["note"] = "; ".join((*found.given_up, *found.fell_back))
    return row | {"start": start, "iterations": found.iterations, "path": "; ".join(steps)}


def _recorded(found: Solution, row: Row) -> Row:
    """Return what the scene records besides."""
    scene = found.scene
    if not (scene.record and found.status.converged):
        return {}
    for name in scene.record:
        if name in (*row, "seconds"):  # which comes last
            raise ModelError(f"record.{name}: every row has that already; choose another name")
    from ribbonopt.scene.stages import parse_record  # formulas, which few need

    return sampled(found, {name: parse_record(text, scene) for name, text in scene.record.items()})


def _save(chunk: dict[str, Any], ribbon: dict[str, Any], row: Row, found: Solution | None) -> None:
    """Keep the full solution where the study wants it."""
    wanted = chunk["save"] == "all" or (chunk["save"] == "failed" and not row["verified"])
    place = _place(chunk, ribbon)
    if not wanted or found is None or place is None:
        return
    from ribbonopt.output.results import save_solution
    from ribbonopt.output.staging import staged_result

    # A worker of a batch that was killed may be there for a moment; not on disk at once, which
    # would cost as much as a solve.
    with staged_result(place, wait=2 * WATCH, durable=False) as stage:
        save_solution(found, stage.folder)
        stage.commit()


def _place(chunk: dict[str, Any], ribbon: dict[str, Any]) -> Path | None:
    """Return the folder of what is kept of a ribbon; None for nowhere."""
    folder = chunk["folder"]
    return Path(folder) / ribbon["place"] if folder else None


def serve() -> None:
    """Serve until stdin ends, or the batch does."""
    threading.Thread(target=_watch, args=(os.getppid(),), daemon=True).start()
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what libraries print must not stand among the answers
    worker = Worker()

    def say(answer: dict[str, Any]) -> None:
        # On a line of its own, whatever else may have been written there.
        answers.write(b"\n" + json.dumps(answer).encode() + b"\n")
        answers.flush()

    try:
        say({"ready": True})
        for line in sys.stdin.buffer:
            for answer in worker.answers(json.loads(line)):
                say(answer)
    except BrokenPipeError:  # nobody wants the rest
        os._exit(0)


def _watch(batch: int) -> None:
    """End with the batch, even in the middle of a ribbon that hangs."""
    while os.getppid() == batch:
        time.sleep(WATCH)
    os._exit(1)
