"""
Solve a scene and look at it
============================

Half of a Möbius ribbon, under Sadowsky's law: solved, verified, drawn, sampled.
"""

# %%
# A scene is text, or a file (``load_scene``). This is half of the ribbon; the other half follows by
# symmetry, and is drawn too.
from ribbonopt import loads_scene, solve

scene = loads_scene("""
name: moebius
law: sadowsky
interval: [0, 0.5]
boundary:
  loop: {half_twists: 1, piece: half}
tolerance: 1e-9
""")
solution = solve(scene)
solution

# %%
# Every number has a bar: an upper bound of its error, estimated from the solution itself.
from ribbonopt import summarize

summary = summarize(solution)
print("energy of the half ", summary["energy"], "+-", summary["error_estimate"]["energy"])
print("force at the start ", summary["n0"], "+-", summary["error_estimate"]["n0"])
print("moment at the start", summary["m0"], "+-", summary["error_estimate"]["m0"])

# %%
# The ribbon as a surface.
solution.plot("ribbon")

# %%
# Bending u2 and twist u3 along it. At s = 0.5, where m2 changes its sign, u2 leaps.
solution.plot("strains")

# %%
# Anything can be sampled anywhere, as a formula of named quantities.
import numpy as np

s = np.linspace(0, 0.5, 5)
print(solution.sample(s, "r"))
print(solution.sample(s, "dot(n, d3)"))

# %%
# Invariants tell how good it is: n . m is the same everywhere.
constant = solution.sample(np.linspace(0, 0.5, 200), "dot(n, m)")
print(np.ptp(constant))
