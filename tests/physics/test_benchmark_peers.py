"""Benchmarks compare what they say: peers solve our problem, and numbers are what they mean."""

import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))

import bench_compiled
import bench_growth
import compiled_cases
import results_tables
from peer_casadi import IPOPT, NEWTON, Collocated
from peer_scipy import Scipy
from peer_states import Ribbon
from profile_answer import group_of

RIBBONS = [Ribbon(whole, states) for whole in (False, True) for states in (13, 18)]


@pytest.mark.parametrize("ribbon", RIBBONS, ids=str)
def test_the_states_of_peers_meet_the_end_from_the_known_loads(ribbon: Ribbon) -> None:
    """Loads known from elsewhere, integrated, hold start and end; loads a bit off do not."""
    parts = ribbon.equations

    def missed(changed: float) -> float:
        turned = [1, 0, 0, 0] if ribbon.states == 13 else np.eye(3).ravel()
        first = np.array([0, 0, 0, *turned, *ribbon.truth])
        first[-5] += changed
        assert np.abs(np.array(parts["start"](first))).max() == 0
        ends = (0, ribbon.length)

        def slope(_: float, x: np.ndarray) -> np.ndarray:
            return np.array(parts["rates"](x, ribbon.epsilon)).ravel()

        last = solve_ivp(slope, ends, first, rtol=1e-11, atol=1e-12, method="DOP853").y[:, -1]
        return float(np.abs(np.array(parts["end"](last))).max())

    assert missed(0.0) < 1e-8
    assert missed(1e-5) > 1e-7


@pytest.mark.parametrize("ribbon", RIBBONS, ids=str)
def test_the_jacobians_of_peers_are_slopes(ribbon: Ribbon) -> None:
    parts, rng = ribbon.equations, np.random.default_rng(3)
    x, dx, step = rng.normal(size=ribbon.states), rng.normal(size=ribbon.states), 1e-6
    for name, more in (("rates", [0.02]), ("start", []), ("end", [])):
        ahead, behind = (np.array(parts[name](x + k * step * dx, *more)) for k in (1, -1))
        slope = np.array(parts[f"{name}_x"](x, *more)) @ dx
        assert np.allclose((ahead - behind).ravel() / (2 * step), slope, rtol=1e-7, atol=1e-7)


@pytest.mark.parametrize("states", [13, 18])
@pytest.mark.parametrize(
    ("solver", "mesh", "error"),
    [(NEWTON, (6, 6, 1e-9), 1e-9), (IPOPT, (10, 3, 1e-10), 1e-5)],
)
def test_casadi_finds_the_half_ribbon(
    solver: str, mesh: tuple[int, int, float], error: float, states: int
) -> None:
    ribbon = Ribbon(False, states)
    found = Collocated(ribbon, solver, *mesh).solve()
    assert bench_compiled.apart(found, ribbon.truth) < error


@pytest.mark.parametrize("ribbon", RIBBONS, ids=str)
def test_scipy_finds_both_ribbons(ribbon: Ribbon) -> None:
    found, _ = Scipy(ribbon).solve(1e-3)
    assert bench_compiled.apart(found, ribbon.truth) < 1e-4


@pytest.mark.parametrize("name", ["half 1e-9", "whole 1e-9"])
def test_an_answer_that_is_timed_is_right(name: str) -> None:
    found = compiled_cases.built(name)(1, 0)
    truth = bench_compiled.ROWS[name][4]
    assert truth is not None
    assert found["verified"]
    assert found["cpu_s"] > 0
    assert bench_compiled.apart(found["numbers"], truth) <= found["bar"] <= 1e-9


def test_growth_is_told_without_what_every_process_takes() -> None:
    counts = (10, 100, 1000, 10_000)
    runs = {n: [[1e-4 * n**1.2, 50_000 + 40.0 * n, 1, 0.0]] for n in counts}
    found = bench_growth.summary(runs)
    assert found["exponent"] == pytest.approx(1.2)
    assert found["kb_an_interval"] == pytest.approx(40)


def test_samples_belong_to_the_library_that_ran() -> None:
    assert [group_of(name) for name in LIBRARIES] == list(LIBRARIES.values())


LIBRARIES = {
    "libpython3.11.so.1.0": "interpreter",
    "_compiled.cpython-311-x86_64-linux-gnu.so": "kernel",
    "_multiarray_umath.cpython-311-x86_64-linux-gnu.so": "numpy",
    "libscipy_openblas64_-32a4b2a6.so": "LAPACK",
    "libcasadi-tp-openblas.so.0": "IPOPT",
    "libcoinmumps.so.3": "IPOPT",
    "libcasadi.so.3.7": "CasADi",
    "_casadi.so": "CasADi",
    "libc.so.6": "libc",
    "[kernel.kallsyms]": "system",
}


def test_other_equilibria_are_counted() -> None:
    pairs = [({"numbers": [2.0, 3.0, 4.0]}, {"numbers": [2.0 + 1e-7, 2.9, 4.1]})]
    assert bench_compiled.energies(pairs, 1e-6) == {"same": 1, "lower": 1, "higher": 1}


def test_a_cell_of_the_page_is_the_quickest_that_is_right() -> None:
    """What did not converge or is off counts for nothing, however quick."""
    peers = [
        {"solve": None, "error": None, "message": "it did not converge", "detail": "a"},
        {"solve": 1e-4, "error": 2e-6, "message": "", "detail": "b"},
        {"solve": 3e-3, "error": 1e-10, "message": "", "detail": "c"},
        {"solve": 2e-3, "error": 9e-10, "message": "", "detail": "d"},
        {"solve": 2e-3, "error": None, "message": "", "detail": "e"},
    ]
    study = {"rows": [], "truth": "t", "peers": [{"name": "P, 13 states"} | row for row in peers]}
    rows = results_tables.measured_rows(study, "P, 13 states")
    assert [row["detail"] for row in rows] == ["b", "c", "d"]
    page = results_tables.ladder(study)
    assert "| P | 13 | 0.1 (2e-06) | 2 (9e-10) | 2 (9e-10) |  |" in page
    assert "No answer: P, 13 states (a): it did not converge." in page
