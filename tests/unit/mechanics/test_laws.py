"""Laws of (u2, u3): what they say is what the paper says, and they can be inverted anywhere."""

from collections.abc import Callable, Iterator
from dataclasses import fields
from typing import get_args

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mp, mpf
from mpmath import sqrt as root

from ribbonopt.mechanics.laws import relations
from ribbonopt.mechanics.laws.catalogue import LAWS, law_class
from ribbonopt.mechanics.laws.law import RibbonLaw
from ribbonopt.scene import Law

CASES: dict[str, list[dict[str, float]]] = {
    "kirchhoff": [{"B2": 1, "B3": 2}, {"B2": 0.3, "B3": 5}],
    "sadowsky": [{}],
    "single_sheet": [{"chi": 1}, {"chi": -1}],
    "regularized": [{"epsilon": e} for e in (0, 1e-8, 1e-3, 1e-2, 0.5)],
    "homotopy": [
        {"rho": rho, "epsilon": e} for rho, e in ((0, 0), (0.3, 0), (0.7, 0.01), (1, 0), (1, 1e-3))
    ],
    "variational": [{"delta": d} for d in (1, 0.3, 0.01, 1e-4)],
}
EVERY = [(name, case) for name in CASES for case in CASES[name]]
every_law = pytest.mark.parametrize(("name", "case"), EVERY, ids=str)

Pairs = np.ndarray  # (2, k): rows m2, m3 or u2, u3


def relation(name: str, case: dict[str, float], which: str) -> Callable[[Pairs], Pairs]:
    """Return strain or moment, or their derivatives, as a function of arrays; numbers as data."""
    a, theta = ca.SX.sym("a", 2), ca.SX.sym("theta", len(case))
    law = law_class(name)(**dict(zip(case, ca.vertsplit(theta), strict=True)))
    kind, _, derivative = which.partition("_")
    assert isinstance(law, RibbonLaw)
    value = ca.vertcat(*(law.strains if kind == "strain" else law.moments)(a[0], a[1]))
    value = ca.jacobian(value, a) if derivative else value
    function = ca.Function("relation", [a, theta], [ca.densify(value)])

    def call(values: Pairs) -> Pairs:
        values = np.atleast_2d(np.asarray(values, dtype=float).T).T
        result = function.map(values.shape[1])(values, list(case.values()) if case else [])
        return np.array(result)

    return call


def applies(name: str, case: dict[str, float], m: Pairs) -> Pairs:
    """Keep the moments that a law has: a sheet has no m3 = 0 with chi m2 < 0 (there u = 0)."""
    if name != "single_sheet":
        return m
    return m[:, (m[1] != 0) | (case["chi"] * m[0] >= 0)]


def moments(decades_of_ratio: float, count: int = 4000, seed: int = 0) -> Pairs:
    """Return random moments over 12 decades of size and both signs."""
    rng = np.random.default_rng(seed)
    size = 10 ** rng.uniform(-6, 6, count)
    angle = np.arctan(10 ** rng.uniform(-decades_of_ratio / 2, decades_of_ratio / 2, count))
    signs = rng.choice([-1.0, 1.0], (2, count))
    return signs * size * np.array([np.sin(angle), np.cos(angle)])


def axes() -> Pairs:
    """Return moments with m3 = 0, with m2 = 0, and zero."""
    size = np.concatenate([-np.logspace(-6, 6, 25), [0.0], np.logspace(-6, 6, 25)])
    zero = np.zeros_like(size)
    return np.hstack([[size, zero], [zero, size]])


def test_every_law_is_tested() -> None:
    # These have their own files: test_rod_law.py, test_wunderlich_law.py, test_quartic_laws.py.
    assert {*CASES, "rod", "wunderlich", "extensible", "sano"} == set(LAWS)


def test_laws_of_scenes_and_of_mechanics_have_the_same_names_and_fields() -> None:
    written = {cls().type: [f.name for f in fields(cls) if f.name != "type"] for cls in LAW_CLASSES}
    assert set(written) == set(LAWS)
    for name in (*CASES, "extensible", "sano"):
        assert written[name] == [f.name for f in fields(law_class(name))]


#: those that a file can say; laws declared in Python have no class here
LAW_CLASSES = [cls for cls in get_args(Law) if isinstance(cls, type)]


@every_law
def test_moment_undoes_strain(name: str, case: dict[str, float]) -> None:
    m = applies(name, case, np.hstack([moments(12), axes()]))
    error = relation(name, case, "moment")(relation(name, case, "strain")(m)) - m
    size = np.linalg.norm(m, axis=0)
    assert (np.linalg.norm(error, axis=0) <= 1e-13 * size + relations.GUARD).all()


@every_law
def test_moment_undoes_strain_next_to_the_axes(name: str, case: dict[str, float]) -> None:
    m = applies(name, case, moments(24))
    error = relation(name, case, "moment")(relation(name, case, "strain")(m)) - m
    assert (np.linalg.norm(error, axis=0) <= 1e-13 * np.linalg.norm(m, axis=0)).all()


@every_law
def test_strain_undoes_moment(name: str, case: dict[str, float]) -> None:
    rng = np.random.default_rng(1)
    u2 = 10 ** rng.uniform(-3, 3, 1000) * rng.choice([-1.0, 1.0], 1000)
    # All laws are one-to-one for |eta| < 1; there, a sheet has the sign of its chi.
    u2 = case["chi"] * np.abs(u2) if name == "single_sheet" else u2
    u = np.array([u2, u2 * rng.uniform(-0.99, 0.99, 1000)])
    error = relation(name, case, "strain")(relation(name, case, "moment")(u)) - u
    assert (np.abs(error).max(axis=0) <= 1e-12 * np.abs(u2)).all()


@every_law
def test_strain_and_derivatives_are_finite_everywhere(name: str, case: dict[str, float]) -> None:
    m = np.hstack([moments(24), axes()])
    assert np.isfinite(relation(name, case, "strain")(m)).all()
    assert np.isfinite(relation(name, case, "strain_derivative")(m)).all()


@every_law
def test_no_moment_no_strain(name: str, case: dict[str, float]) -> None:
    assert (np.abs(relation(name, case, "strain")(np.zeros((2, 1)))) <= 1e-49).all()
    assert (relation(name, case, "moment")(np.zeros((2, 1))) == 0).all()


@every_law
def test_derivatives_of_moment_undo_those_of_strain(name: str, case: dict[str, float]) -> None:
    m = applies(name, case, moments(2, 200, seed=2))
    m = m / np.linalg.norm(m, axis=0)
    if name == "single_sheet":
        m = m[:, case["chi"] * m[0] > 0]
    forward = relation(name, case, "strain_derivative")(m).reshape(2, -1, 2).swapaxes(0, 1)
    back = relation(name, case, "moment_derivative")(relation(name, case, "strain")(m))
    back = back.reshape(2, -1, 2).swapaxes(0, 1)
    assert np.abs(back @ forward - np.eye(2)).max() <= 1e-9


@every_law
@given(
    exponent=st.integers(-40, 40),
    m2=st.floats(-1, 1).filter(lambda x: x == 0 or abs(x) > 1e-12),
    m3=st.floats(0.01, 1),
)
def test_strain_is_homogeneous(
    name: str, case: dict[str, float], exponent: int, m2: float, m3: float
) -> None:
    strain, k = relation(name, case, "strain"), 2.0**exponent
    np.testing.assert_array_equal(strain([[m2 * k], [m3 * k]]), k * strain([[m2], [m3]]))


def paper(name: str, m2: mpf, m3: mpf, **numbers: float) -> tuple[mpf, mpf]:
    """Strains in high precision, by the formulas of the paper (m2, m3 not zero)."""
    c = {key: mpf(value) for key, value in numbers.items()}
    M = root(m2**2 + m3**2)
    if name == "kirchhoff":
        return m2 / c["B2"], m3 / c["B3"]
    if name == "single_sheet":  # (B 1), the signs in the denominators mended
        bracket = m2**2 + m3**2 - m2 * c["chi"] * M
        return c["chi"] / 4 * m3**4 * M / bracket**2, m3**3 / bracket / 4
    if name == "variational":
        delta = c["delta"]
        q = root(m2**2 + delta**2 * m3**2)
        return m2 * (q + M) ** 2 / (4 * q * M), m3 * (q + M) * (q + delta**2 * M) / (4 * q * M)
    a = m2 / m3
    lam = 1 + 2 * a**2 - 2 * root(a**4 + a**2)  # (4.2)
    if name == "sadowsky":  # (4.3), (4.4)
        return m2 / ((1 - lam) * (1 + lam)), m3 / (2 * (1 + lam))
    if name == "regularized":  # (6.1), (4.4)
        return m2 / ((1 - lam + c["epsilon"]) * (1 + lam)), m3 / (2 * (1 + lam))
    rho = c["rho"]  # (C 1)
    bending = (1 - rho * (lam - c["epsilon"])) * (1 + rho * lam)
    return m2 / bending, m3 / (2 * (1 + rho * lam))


def exact_strains(name: str, case: dict[str, float], m: Pairs) -> Iterator[tuple[mpf, mpf]]:
    for m2, m3 in m.T:
        yield paper(name, mpf(float(m2)), mpf(float(m3)), **case)


@every_law
def test_strain_is_that_of_the_paper(name: str, case: dict[str, float]) -> None:
    m = moments(12, 300, seed=3)
    found = relation(name, case, "strain")(m)
    with mp.workdps(80):
        for (u2, u3), exact in zip(found.T, exact_strains(name, case, m), strict=True):
            assert abs(mpf(float(u2)) / exact[0] - 1) <= 4e-15
            assert abs(mpf(float(u3)) / exact[1] - 1) <= 4e-15


def test_the_printed_single_sheet_does_not_undo_the_moments() -> None:
    m2, m3 = mpf(1), mpf(2)
    M = root(m2**2 + m3**2)
    printed = m2**2 + m3**2 + m2 * M
    u2, u3 = m3**4 * M / printed**2 / 4, m3**3 / printed / 4
    assert abs(u2 * (1 - (u3 / u2) ** 4) - m2) > 1  # (2.4)


def test_strains_of_sheets_meet_the_papers_relations() -> None:
    m = applies("single_sheet", {"chi": -1}, moments(6, 300, seed=4))
    u2, u3 = relation("single_sheet", {"chi": -1}, "strain")(m)
    assert (u2 < 0).all()
    size = np.linalg.norm(m, axis=0)
    eta = u3 / u2
    # (2.4), (2.5); beyond |eta| = 1 they amplify the rounding of eta.
    bound = 1e-14 * (1 + np.abs(eta)) ** 4 * np.abs(u2)
    assert (np.abs(u2 * (1 - eta**4) - m[0]) <= bound + 1e-15 * size).all()
    assert (np.abs(2 * u3 * (1 + eta**2) - m[1]) <= bound + 1e-15 * size).all()


@every_law
def test_guard_changes_no_bit(
    name: str, case: dict[str, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    m = moments(12, 2000, seed=5)
    if name == "single_sheet":
        # Beyond m2 = 0 the size of a sheet's strain is m3^2 / |m|.
        m = m / np.abs(m[1])
    else:
        m = m / np.linalg.norm(m, axis=0)
    m = m * 10.0 ** np.linspace(-39.9, 6, m.shape[1])
    guarded = relation(name, case, "strain")(m)
    monkeypatch.setattr(relations, "GUARD", 0.0)
    unguarded = relation(name, case, "strain")
    assert name == "kirchhoff" or np.isnan(unguarded(np.zeros((2, 1)))).any()
    np.testing.assert_array_equal(guarded, unguarded(m))


@every_law
def test_laws_are_odd(name: str, case: dict[str, float]) -> None:
    mirrored = {"chi": -case["chi"]} if "chi" in case else case
    m = moments(12, 300, seed=7)
    here, there = relation(name, case, "strain")(m), relation(name, mirrored, "strain")(-m)
    np.testing.assert_array_equal(here, -there)
