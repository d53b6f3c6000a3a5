"""Laws of a ribbon in its plane beside the same laws in space, at m1 = m3 = 0."""

import casadi as ca
import numpy as np
import pytest

from ribbonopt.arrays import Array
from ribbonopt.mechanics.laws.catalogue import LAWS, bends_alone, capabilities
from ribbonopt.mechanics.laws.law import ConstitutiveLaw, Stress
from ribbonopt.scene import Scene, loads_scene

NUMBERS = {
    "kirchhoff": "B2: 1.3, B3: 0.7",
    "rod": "B: [3, 1.3, 0.7], natural: [0, 0.8, 0]",
    "regularized": "epsilon: 0.1",
    "homotopy": "rho: 0.6, epsilon: 0.1",
    "variational": "delta: 0.2",
    "wunderlich": "width: 0.2",
    "extensible": "width: 0.1, thickness: 0.01, poisson_ratio: 0.3",
    "sano": "B2: 1, B3: 1.1, zeta: 0.3",
}
MOMENTS = [m2 for m2 in np.linspace(-20, 20, 9) + 0.3]  # none of which is zero
ONE_SIDED = {"single_sheet"}  # it is rigid on the other side: in its plane as in space
#: not for a rod, which says what is natural of it
NATURAL = {name for name in LAWS if name not in ("rod", *ONE_SIDED)}


def scene(law: str, more: str = "") -> Scene:
    edge = ", edge: straight" if law == "wunderlich" else ""
    numbers = f", {NUMBERS[law]}" if law in NUMBERS else ""
    end = f"{{position: [0, 0, 0.8], directors: identity{edge}}}"
    return loads_scene(
        f"name: bent\nlaw: {{type: {law}{numbers}}}\n"
        f"boundary: {{start: {end.replace('0.8', '0')}, end: {end}}}\n{more}\n"
    )


def both(law: str, more: str = "") -> tuple[ConstitutiveLaw, ConstitutiveLaw]:
    return capabilities(scene(law, more)), capabilities(scene(law, more + "\nstates: planar"))


def values(law: ConstitutiveLaw, m2: float) -> Array:
    """Return strains (3,), both densities, and what switches, at a place where all is given."""
    own = ca.SX.zeros(len(law.states))
    stress = Stress(ca.SX([0.4, 0.0, -2.0]), ca.SX([0.0, m2, 0.0]), own)
    u = law.strain(stress)
    parts = ca.vertcat(u, *law.densities(stress, u), law.switching(stress).value)
    free = ca.symvar(parts)  # natural strains, of which that along is not zero
    known = [1.5 if "curvature" in v.name() else 0.0 for v in free]
    function = ca.Function("values", [ca.vertcat(ca.SX(0, 1), *free)], [parts])
    return np.array(function(known)).ravel()


@pytest.mark.parametrize("law", sorted(set(LAWS) - ONE_SIDED))
def test_in_its_plane_a_law_is_what_it_is_in_space(law: str) -> None:
    for more in ["", "natural: {curvature: 1.5}"] if law in NATURAL else [""]:
        space, plane = both(law, more)
        for m2 in MOMENTS:
            np.testing.assert_allclose(values(plane, m2), values(space, m2), rtol=1e-13, atol=1e-13)
        assert plane.smooth
        assert not (plane.kinked or plane.states)
        assert plane.developable == space.developable
        known = Stress.of_moment(ca.SX([0.0, 1.0, 0.0]))
        assert plane.singular(known) == ()
        moment = plane.moment(plane.strain(known))
        free = ca.vertcat(ca.SX(0, 1), *ca.symvar(moment))
        inverse = ca.Function("moment", [free], [moment])
        assert float(inverse(np.ones(free.numel()))) == pytest.approx(1, rel=1e-12)


def test_a_strip_curved_across_leaps_in_its_plane_too() -> None:
    curved = "natural: {curvature: 1.5, across: 0.4, poisson_ratio: 0.3}"
    assert both("sadowsky", curved)[1].kinked
    coupled = "natural: {curvature: 1.5, poisson_ratio: 0.3}"
    assert both("sadowsky", coupled)[1].kinked
    # What may be brought on, or is no one number, counts as there.
    along = 'natural: {across: "0*s"}'
    assert not bends_alone(scene("sadowsky", along))
    brought = "natural: {curvature: 1}\ncontinuation: {parameter: natural.across, to: 1}"
    assert not bends_alone(scene("sadowsky", brought))
    assert both("single_sheet")[1] is not None
