"""Clamps that the extensions are tried in; numbers computed independently of this package.

Shooting of order 8 and collocation of the energy alone, which share no equations, agree to all
digits. Units Dw = L = 1.
"""

from ribbonopt.scene import Boundary, End, RotationVector

CLAMPED = End("clamped", (0.0, 0.0, 0.0), "identity")
#: a clamp without any symmetry
GENERIC = Boundary(CLAMPED, End("clamped", (0.68, 0.15, 0.31), RotationVector((0.0, 2.4, 0.6))))
EQUATIONS = ("inverted", "algebraic", "differentiated")
FORMULATIONS = (*EQUATIONS, "energy")
