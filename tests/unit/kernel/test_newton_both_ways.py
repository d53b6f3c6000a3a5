"""Newton's loop in the kernel: the same iterations, ends and numbers as without it."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fresh import ROOT
from newton_runs import SCENES, runs_of

Runs = dict[str, dict[str, dict[str, Any]]]
FAILED = {"SINGULAR", "STALLED", "MAX_ITERATIONS", "INVALID_NUMBER"}


@pytest.fixture(scope="module")
def without() -> Runs:
    """Return the runs of an interpreter that does without the kernel."""
    paths = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH", "")]))
    done = subprocess.run(
        [sys.executable, str(Path(__file__).with_name("newton_runs.py")), *SCENES],
        stdout=subprocess.PIPE,
        check=True,
        env=os.environ | {"RIBBONOPT_KERNEL": "off", "PYTHONPATH": paths},
    )
    found = json.loads(done.stdout)
    assert found["state"] == "off (RIBBONOPT_KERNEL)"
    runs: Runs = found["runs"]
    return runs


@pytest.mark.usefixtures("kernel")
@pytest.mark.parametrize("name", SCENES)
def test_newton_walks_the_same_way(name: str, without: Runs) -> None:
    with_kernel, numpy = json.loads(json.dumps(runs_of(name))), without[name]
    assert with_kernel.keys() == numpy.keys()
    for kind, found in with_kernel.items():
        expected = numpy[kind]
        assert (found["status"], found["counts"]) == (expected["status"], expected["counts"]), kind
        if found["status"] == "CONVERGED":
            a, b = np.array(found["w"]), np.array(expected["w"])
            assert np.max(np.abs(a - b) / (1 + np.abs(b))) <= 1e-13, kind


def test_the_runs_end_in_every_way(without: Runs) -> None:
    """Otherwise little is compared above."""
    ends = {run["status"] for runs in without.values() for run in runs.values()}
    assert ends == FAILED | {"CONVERGED"}
    inherited = [runs["inherited"]["counts"] for runs in without.values()]
    assert min(count for _, count in inherited) == 0 < max(count for _, count in inherited)
