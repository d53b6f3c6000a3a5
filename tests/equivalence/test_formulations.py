"""The same ribbon written in every formulation is the same ribbon."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from references import HALF_MOEBIUS, REGULARIZED

from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.checks.verify import verify
from ribbonopt.errors import ModelError
from ribbonopt.output.report import report
from ribbonopt.output.results import load_solution, save_solution
from ribbonopt.output.summary import summarize
from ribbonopt.pipeline.check import check_scene
from ribbonopt.pipeline.prepared import Prepared, prepare, solve
from ribbonopt.scene import load_scene
from ribbonopt.solution.made import solution_of
from ribbonopt.solution.solution import Solution

Solved = Callable[..., Solution]

BOUNDED, FREE = "formulation=algebraic", "formulation={type: algebraic, bounds: false}"
EQUATIONS = ("formulation=inverted", BOUNDED, FREE, "formulation=differentiated")
ENERGY = "formulation=energy"

# Loads n(0), m(0): SCIENCE section 5 (half and whole Moebius), the exact helix (section 5), the
# elastica of elliptic integrals, SCIENCE-NEXT section 5 (extensible ribbon).
TRUTH = {
    "moebius_half": (HALF_MOEBIUS["n0"], HALF_MOEBIUS["m0"]),
    "moebius_regularized": (REGULARIZED[1e-2]["n0"], REGULARIZED[1e-2]["m0"]),
    "helix_clamped": ((0, 12.5, 6.25), (0, 3.75, 5)),
    "elastica_clamped": ((0, 0, -45.2259556678), (0, 6.61180050, 0)),
    "extensible_clamped": (
        (-3.2860898525, -3.7762068058, -1.7395962384),
        (2.2251158402, 1.6110355251, -0.0653687590),
    ),
}
# Digits to which the truth above is known.
KNOWN = {"elastica_clamped": 1e-8, "extensible_clamped": 6e-11}


def errors(found: Solution, name: str) -> tuple[float, float]:
    n, m = TRUTH[name]
    return float(np.abs(found.n0 - n).max()), float(np.abs(found.m0 - m).max())


@pytest.mark.parametrize("states", ["reduced", "full"])
@pytest.mark.parametrize("formulation", EQUATIONS)
@pytest.mark.parametrize("name", list(TRUTH))
def test_equilibrium_agrees_within_its_own_error(
    solved: Solved, name: str, formulation: str, states: str
) -> None:
    found = solved(name, formulation, f"states={states}")
    assert found.verified
    bars = estimate_error(found)
    known = KNOWN.get(name, 1e-12)
    for error, bar in zip(errors(found, name), (bars["n0"], bars["m0"]), strict=True):
        assert error <= 5 * bar + known


@pytest.mark.parametrize("name", ["moebius_half", "helix_clamped", "elastica_clamped"])
def test_minimum_of_the_energy_is_the_equilibrium(solved: Solved, name: str) -> None:
    found = solved(name, ENERGY)
    assert found.verified
    # Convexified energy: controls (u2, u3, k); the loads are its costates.
    assert max(errors(found, name)) < 1e-7
    n = np.array(TRUTH[name][0])
    assert found.sample(0.1, "dot(n, n)") == pytest.approx(n @ n, rel=1e-8)
    assert found.energy == pytest.approx(solved(name).energy, rel=1e-9)


def test_minimum_of_the_smooth_energy_is_the_equilibrium(solved: Solved) -> None:
    """SCIENCE section 5: delta = 0.1 gives u2(0) = 3.3500324."""
    law = "law={type: variational, delta: 0.1}"
    found = solved("moebius_half", ENERGY, law)
    assert found.verified
    assert found.u0[1] == pytest.approx(3.3500324, abs=1e-5)
    exact = solved("moebius_half", law)
    np.testing.assert_allclose(found.n0, exact.n0, atol=1e-5)
    np.testing.assert_allclose(found.m0, exact.m0, atol=1e-5)


def test_natural_conditions_hold_though_not_imposed(solved: Solved) -> None:
    found = solved("moebius_half", ENERGY)
    assert not any("force" in name or "moment" in name for name in found.problem.conditions)
    assert abs(found.sample(0.0, "n1")) < 1e-8
    assert abs(found.sample(0.0, "m1")) < 1e-8


def test_constant_strains_lead_to_the_moebius_ribbon(configs: Path) -> None:
    """Energy form, delta = 0.3 to 0.01, then the inverted form: no load known beforehand."""
    path = configs / "moebius_half.yaml"
    mesh = "transcription={type: collocation, scheme: gauss, degree: 3, intervals: 20}"
    start, found, iterations = "guess={strains: [6.28, 3.14]}", None, 0
    built = prepare(load_scene(path, [ENERGY, "law={type: variational, delta: 0.3}", mesh, start]))
    for delta in (0.3, 0.1, 0.03, 0.01):
        law = f"law={{type: variational, delta: {delta}}}"
        found = built.solve(load_scene(path, [ENERGY, law, mesh, start]), guess=found)
        assert found.verified
        iterations += found.iterations
    assert iterations <= 60
    fine = "transcription={type: collocation, scheme: gauss, degree: 8, intervals: 80}"
    law = "law={type: variational, delta: 0.01}"
    polished = prepare(load_scene(path, [law, fine])).solve(guess=found)
    assert polished.verified
    np.testing.assert_allclose(found.n0, polished.n0, atol=1e-3)
    np.testing.assert_allclose(found.m0, polished.m0, atol=1e-3)
    assert polished.u0[1] == pytest.approx(3.3833029, abs=5e-8)  # SCIENCE section 5
    assert max(estimate_error(polished)[k] for k in ("n0", "m0")) < 1e-11
    # The same guess polishes the law of the paper to twelve digits.
    exact = prepare(load_scene(path, ["transcription.degree=8"])).solve(guess=found)
    n, m = (np.array(v) for v in TRUTH["moebius_half"])
    np.testing.assert_allclose(exact.n0, n, atol=1e-12 * 43)
    np.testing.assert_allclose(exact.m0, m, atol=1e-12 * 43)


@pytest.mark.parametrize("law", ["{type: regularized}", "{type: homotopy, rho: 0.5}"])
def test_energy_needs_a_law_with_an_energy(configs: Path, law: str) -> None:
    with pytest.raises(ModelError, match=r"no energy.*variational"):
        prepare(load_scene(configs / "moebius_half.yaml", [ENERGY, f"law={law}"]))


def test_energy_refuses_loads_without_a_potential(configs: Path) -> None:
    follower = [ENERGY, "boundary.end.force={d1: 1, d2: 0, d3: 0}"]
    with pytest.raises(ModelError, match=r"force.d1, other than zero, has no potential"):
        prepare(load_scene(configs / "cantilever.yaml", follower))


def test_energy_refuses_director_components(configs: Path) -> None:
    with pytest.raises(ModelError, match="states: reduced"):
        prepare(load_scene(configs / "moebius_half.yaml", [ENERGY, "states=full"]))


class TestForbiddenRegion:
    """A helix with u2 = 2, u3 = 4 solves (2.1)-(2.7), but (4.1) forbids it: eta = 2."""

    @staticmethod
    def from_the_wrong_side(
        configs: Path, formulation: str
    ) -> tuple[Prepared, np.ndarray, np.ndarray]:
        wrong = ("parameters={curvature: 2, torsion: 4}", "guess={strains: [2, 4]}")
        built = prepare(load_scene(configs / "helix.yaml", [formulation, *wrong]))
        w, p = built.start()
        nodes, stages, _ = built.nlp.layout.unpack(w)
        stages = stages.copy()
        stages[:, :, 7:] = 2, 4
        # SCIENCE section 5: loads of the helix, in directors, which are the lab axes at the start.
        return built, built.nlp.layout.pack(nodes, stages, np.array([0, 200, 400, 0, -30, 40.0])), p

    def test_without_bounds_it_can_be_entered(self, configs: Path) -> None:
        built, w, p = self.from_the_wrong_side(configs, FREE)
        report = built.solver.solve(w, p)
        assert report.status.converged
        _, stages, _ = built.nlp.layout.unpack(report.w)
        np.testing.assert_allclose(stages[:, :, 8] / stages[:, :, 7], 2, rtol=1e-8)

    def test_bounds_keep_out_of_it(self, configs: Path) -> None:
        built, w, p = self.from_the_wrong_side(configs, BOUNDED)
        report = built.solver.solve(w, p)
        _, stages, _ = built.nlp.layout.unpack(report.w)
        inside = np.abs(stages[:, :, 8]) <= np.abs(stages[:, :, 7]) * (1 + 1e-8)
        assert inside.all() or not report.status.converged

    def test_what_entered_is_not_called_a_solution(self, configs: Path) -> None:
        built, w, p = self.from_the_wrong_side(configs, FREE)
        report = built.solver.solve(w, p)
        found = solution_of(built.posed(), built.problem, built.nlp, report, p)
        assert any("(4.1) forbids" in problem for problem in verify(found, built.ribbon).problems)


def test_law_drifts_where_it_is_only_differentiated(solved: Solved) -> None:
    drifts = [
        solved(
            "moebius_half", "formulation=differentiated", f"transcription.intervals={n}"
        ).verification.law_residual
        for n in (10, 20, 40)
    ]
    assert drifts[0] > drifts[1] > drifts[2] > 0
    assert solved("moebius_half", FREE).verification.law_residual < 1e-14


def test_loads_from_costates_are_said_saved_and_loaded(solved: Solved, tmp_path: Path) -> None:
    found = solved("moebius_half", ENERGY)
    assert summarize(found)["loads_from"] == "costates"
    assert "recovered from the costates" in report(summarize(found))
    assert "recovered" not in report(summarize(solved("moebius_half")))
    save_solution(found, tmp_path)
    np.testing.assert_array_equal(load_solution(tmp_path).n0, found.n0)


def test_what_is_skipped_depends_on_the_formulation(configs: Path) -> None:
    def said(formulation: str) -> str:
        scene = load_scene(configs / "moebius_half.yaml", [formulation])
        return " ".join(check_scene(scene)["skipped"])

    assert "second derivatives" in said("formulation=inverted")
    assert "IPOPT" in said("formulation=inverted")
    assert "IPOPT" not in said(BOUNDED)
    assert "second derivatives" not in said(ENERGY)


@pytest.mark.parametrize("states", ["reduced", "full"])
@pytest.mark.parametrize("formulation", [BOUNDED, FREE])
def test_an_end_without_moment_has_strains_in_the_algebraic_form(
    configs: Path, formulation: str, states: str
) -> None:
    # There the equations of the law are singular.
    law = "law={type: regularized, epsilon: 0.1}"
    overrides = [law, formulation, f"states={states}"]
    found = solve(load_scene(configs / "cantilever.yaml", overrides))
    assert found.verified, found.message
    np.testing.assert_allclose(found.sample(1.0, "u"), 0, atol=1e-9)
