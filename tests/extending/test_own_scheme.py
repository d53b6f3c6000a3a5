"""A collocation scheme of a user's own keeps the order that it declares."""

import numpy as np
import pytest
from analytic import rational, rational_exact
from user_modules import Import

from ribbonopt.solvers import NewtonSolver
from ribbonopt.transcription import CollocationMethod, Mesh
from ribbonopt.transcription.collocation.output import DenseOutput


@pytest.mark.parametrize(("degree", "counts"), [(2, (32, 64, 128)), (3, (16, 32, 64))])
def test_a_scheme_keeps_the_order_it_declares(
    user: Import, degree: int, counts: tuple[int, ...]
) -> None:
    tableau, errors = user("left_radau").left_radau(degree), []
    for count in counts:
        nlp = CollocationMethod(tableau).transcribe(rational(), (count,))
        p = nlp.layout.parameters(np.empty(0), Mesh.uniform(count).widths)
        report = NewtonSolver(nlp).solve(np.ones(nlp.unknowns), p)
        assert report.status.converged
        dense = DenseOutput(nlp.blocks, report.w, p)
        s = dense.nodes(0)
        errors.append(np.abs(dense.states(0, s) - rational_exact(s)).max())
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert order == pytest.approx(tableau.order, abs=0.3)
