"""The survey of a map whose branches, loci and counts are written down: what is asked, and told."""

from collections.abc import Callable, Sequence
from functools import partial

import pytest
from made_maps import SCENE, SLOPES, done

from ribbonopt.plain import Row
from ribbonopt.scene import loads_scene
from ribbonopt.studies.batch.study import StudyRibbon
from ribbonopt.studies.maps.jobs import Job
from ribbonopt.studies.maps.survey import Survey
from ribbonopt.studies.maps.written import NOTHING, data_of, rows_of


def surveyed(do: Callable[..., Row] = done, text: str = SCENE) -> tuple[Survey, list[str]]:
    asked: list[str] = []

    def work(what: str, jobs: Sequence[Job]) -> list[Row]:
        asked.extend(job.place for job in jobs)
        return [do(job.ribbon(number)) for number, job in enumerate(jobs)]

    scene = loads_scene(text)
    assert scene.map is not None
    survey = Survey(scene, scene.map, work)
    survey.explore()
    return survey, asked


def test_each_locus_is_followed_once_and_regions_are_counted() -> None:
    survey, asked = surveyed()
    assert [place for place in asked if place.startswith("map-loci")] == [
        "map-loci/1",
        "map-loci/2",
        "map-loci/3",
    ]
    assert len(survey.lines) == 3
    data = data_of(survey)
    assert data["status"] == "converged"
    assert survey.doubts == []
    counts = {(region["count"], region["stable"]) for region in data["regions"]}
    assert counts == {(7, 2), (5, 1), (3, 1), (1, 1)}
    assert [locus["changes"] for locus in data["loci"]] == [True, False, False]
    assert len([*rows_of(survey)]) == sum(len(locus.points) for locus in survey.loci)
    areas = sorted(region.face.area for region in survey.regions)
    between = [(b - a) / 80 * (0.4**1.5 - 0.05**1.5) / 1.5 / 0.35 for a, b in [SLOPES[:2]]]
    assert areas[0] == pytest.approx(between[0], rel=1e-4)


def test_what_does_not_fit_is_counted_again_and_told() -> None:
    survey, _ = surveyed(partial(done, wrong=True))
    right, _ = surveyed()
    assert len(survey.points) > len(right.points)
    assert any("a locus or a shape was missed" in doubt for doubt in survey.doubts)


def test_lines_without_special_points_say_so() -> None:
    survey, _ = surveyed(partial(done, slopes=()))
    data = data_of(survey)
    assert data["status"] == NOTHING
    assert "no fold or branch point" in data["message"]
    assert len(data["regions"]) == 1


def test_a_line_that_fails_is_told_and_the_others_go_on() -> None:
    def lose(ribbon: object) -> Row:
        row = done(ribbon)  # type: ignore[arg-type]
        if ribbon.place == "map-branches/2":  # type: ignore[attr-defined]
            row |= {"verified": False, "status": "crashed", "message": "gone", "specials": []}
        return row

    survey, _ = surveyed(lose)
    assert len(survey.loci) == 3
    data = data_of(survey)
    assert [line["verified"] for line in data["lines"]] == [True, False, True]


def test_other_points_are_counted_in_their_region() -> None:
    points = "  points: [[70, 0.1], [10, 0.3]]\n"
    survey, _ = surveyed(text=SCENE + points)
    (far, near) = survey.points[-2:]
    assert survey.regions[far["region"]].face.area < 0.5
    assert (far["count"], near["count"]) == (1, 7)


def test_another_image_is_tried_where_a_locus_leads_nowhere() -> None:
    def twice(ribbon: StudyRibbon) -> Row:
        row = done(ribbon)
        if ribbon.task == "line":
            images = [{**s, "near": {**s["near"], "point": s["point"]}} for s in row["specials"]]
            row["specials"] += [{**image, "folder": "map-branches/1/2"} for image in images]
        if ribbon.task == "locus" and ribbon.inputs["folder"] == "map-branches/1/1":
            row |= {"verified": False, "status": "not_followed", "message": "no", "points": []}
        return row

    survey, asked = surveyed(twice)
    assert [place for place in asked if "loci" in place] == [f"map-loci/{i}" for i in range(1, 7)]
    assert survey.doubts == []
    assert len(survey.regions) == 4


def test_a_locus_that_leads_nowhere_is_told() -> None:
    def lose(ribbon: StudyRibbon) -> Row:
        row = done(ribbon)
        if ribbon.task == "locus":
            row |= {"verified": False, "status": "not_followed", "message": "no", "points": []}
        return row

    survey, _ = surveyed(lose)
    assert len([doubt for doubt in survey.doubts if doubt.startswith("locus at")]) == 8
    assert len(survey.regions) == 1
