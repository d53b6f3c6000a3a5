"""Law, load, support and export of a user's own in one solve, and pictures of what can be drawn."""

from pathlib import Path

import numpy as np
from clamps import CLAMPED
from user_modules import Import

from ribbonopt import save_solution, solve
from ribbonopt.output.exports import STANDARD
from ribbonopt.scene import Boundary, End, LabVector, Loads, Scene
from ribbonopt.views import Pictures


def test_together(user: Import, tmp_path: Path) -> None:
    rod, roller, pressure = user("rod").Rod(k1=0.4), user("roller").ROLLER, user("pressure")
    scene = Scene(
        "together",
        rod,
        Boundary(CLAMPED, End(roller, LabVector(x=0.3))),
        loads=Loads(own=(pressure.Pressure(2.0),)),
    )
    found = solve(scene)
    assert found.verified
    ends = found.outputs(np.array([0.0, 1.0]))
    np.testing.assert_allclose(ends["r"][1, 0], 0.3, atol=1e-9)
    np.testing.assert_allclose(ends["n"][1, 1:], 0, atol=1e-9)
    np.testing.assert_allclose(ends["m"][1], 0, atol=1e-9)
    # What the pressure brings into the ribbon leaves it at both ends.
    brought = 2.0 * found.sample((np.arange(400) + 0.5) / 400, "d1").mean(axis=0)
    np.testing.assert_allclose(ends["n"][0] - ends["n"][1], brought, atol=1e-4)
    left_out = save_solution(found, tmp_path, [user("centre_line").CentreLine(), Pictures()])
    assert [text.partition(":")[0] for text in left_out] == [
        "scene.yaml",
        "plane.png",
    ]
    assert "'roller' is declared in Python" in left_out[0]
    standard = {name for export in STANDARD for name in export.files} - {"scene.yaml"}
    written = {*standard, "exports.json", "centre.txt", "strains.png", "ribbon.png"}
    assert {path.name for path in tmp_path.iterdir()} == written
    np.testing.assert_allclose(np.loadtxt(tmp_path / "centre.txt")[-1], ends["r"][1])
