"""IPOPT through CasADi: the solver that globalises, bounds and minimises.

Settings that decide speed (measured in `scripts/bench_path.py`): no scaling, so that the tolerance
means the residual; MUMPS with the minimum-degree ordering and without a permutation to a heavy
diagonal, which a symmetric matrix does not need; for square programs no Hessian at all.
"""

from __future__ import annotations

import time
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription import NLP

from .status import SolveReport, Status

DUAL_ROUNDING = 1e-8  # dual infeasibility, absolute, that rounding leaves in flat directions

_STATUS = {
    "Solve_Succeeded": Status.CONVERGED,
    "Solved_To_Acceptable_Level": Status.STALLED,
    "Feasible_Point_Found": Status.CONVERGED,
    "Infeasible_Problem_Detected": Status.INFEASIBLE,
    "Search_Direction_Becomes_Too_Small": Status.STALLED,
    "Diverging_Iterates": Status.INFEASIBLE,
    "Maximum_Iterations_Exceeded": Status.MAX_ITERATIONS,
    "Restoration_Failed": Status.INFEASIBLE,
    "Error_In_Step_Computation": Status.SINGULAR,
    "Not_Enough_Degrees_Of_Freedom": Status.SINGULAR,
    "Invalid_Number_Detected": Status.INVALID_NUMBER,
}


# How CasADi tells of Ctrl-C, which it takes for itself; nothing else of ours throws there.
INTERRUPTED = "NonIpopt_Exception_Thrown"


@dataclass(frozen=True, eq=False)
class IpoptSolver:
    """IPOPT with MUMPS on one NLP; `tolerance` bounds residuals and dual infeasibility."""

    nlp: NLP
    tolerance: float = 1e-12
    max_iterations: int = 200

    @cached_property
    def solver(self) -> ca.Function:
        """The CasADi solver, built at first use and kept."""
        nlp, functions = self.nlp, self.nlp.functions
        w, p = ca.MX.sym("w", nlp.unknowns), ca.MX.sym("p", nlp.parameters)
        options: dict[str, Any] = {
            "jac_g": functions.jacobian,
            "hess_lag": functions.hessian,
            "print_time": False,
            "calc_lam_p": False,
            "calc_lam_x": False,
            "calc_f": False,
            "calc_g": False,
            "error_on_fail": False,
            "show_eval_warnings": False,
            "ipopt": {
                "print_level": 0,
                "sb": "yes",
                "option_file_name": "",  # an ipopt.opt of the working folder is not read
                "max_iter": self.max_iterations,
                "tol": self.tolerance,
                "constr_viol_tol": self.tolerance,
                "acceptable_iter": 0,
                "nlp_scaling_method": "none",
                "linear_solver": "mumps",
                "mumps_pivot_order": 0,
                "mumps_permuting_scaling": 0,
                "mumps_mem_percent": 100,
            },
        }
        problem: dict[str, Any] = {
            "x": w,
            "p": p,
            "f": functions.cost(w, p),
            "g": functions.constraints(w, p),
        }
        return ca.nlpsol("ipopt", "ipopt", problem, options)

    def build(self) -> None:
        """Build the solver now rather than at the first solve."""
        _ = self.solver

    def _at_rounding(self, history: dict[str, list[float]]) -> bool:
        """Whether IPOPT stopped because steps no longer change anything: solved all the same."""
        feasible = history["inf_pr"][-1] <= 10 * self.tolerance
        return feasible and history["inf_du"][-1] <= DUAL_ROUNDING

    def solve(self, w: Array, p: Array, *, enough: float = 0.0) -> SolveReport:
        """Solve from the guess w (nw,) for the parameters p (np,).

        Always to its own tolerance, which is built in, whatever is `enough`.
        """
        lower = np.where(self.nlp.inequality, -np.inf, 0.0)
        solver = self.solver
        start = time.perf_counter()
        result = solver(x0=w, p=p, lbg=lower, ubg=0.0)
        total = time.perf_counter() - start
        stats = solver.stats()
        if stats["return_status"] == INTERRUPTED:
            raise KeyboardInterrupt
        status = _STATUS.get(stats["return_status"], Status.INFEASIBLE)
        if status is Status.STALLED and self._at_rounding(stats["iterations"]):
            status = Status.CONVERGED
        evaluate = sum(value for key, value in stats.items() if key.startswith("t_wall_nlp_"))
        solution = np.array(result["x"]).ravel()
        # Evaluated again: where IPOPT gave up on numbers that are not finite, it returns zeros.
        residuals = np.array(self.nlp.functions.constraints(solution, p)).ravel()
        return SolveReport(
            status=status,
            w=solution,
            multipliers=np.array(result["lam_g"]).ravel(),
            residuals=residuals,
            iterations=int(stats["iter_count"]),
            factorizations=int(stats["iter_count"]),
            evaluate=evaluate,
            linear=total - evaluate,
            total=total,
            solver="ipopt",
        )
