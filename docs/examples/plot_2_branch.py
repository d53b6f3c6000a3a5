"""
Follow a branch around a fold
=============================

A strip bowed between two clamps, one of which turns against the bow until the strip snaps. The
branch of equilibria is followed through the fold, and it is told which of them are stable.
"""

# %%
# The scene says what is followed: the angle of a clamp, until the middle is level.
from ribbonopt import Branch, Continuation, loads_scene

scene = loads_scene("""
name: snap
law: {type: variational, delta: 0.1}
parameters: {angle: 0}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0, 0.9], directors: {turns: [{y: angle*deg}]}}
guess: {force: [0, 0, -42], moment: [0, 4, 0]}
tolerance: 1e-8
record: {middle: "dot(r, ex) at 0.5"}
continuation: {parameter: parameters.angle, from: 0, to: 40, largest: 5, stop: ["middle < 0.02"]}
""")
branch = Branch.of(Continuation(scene))
branch

# %%
# Special points have bars of their own. The planar elastica folds at 32.3633539404 degrees.
for row in branch.special:
    print(row["kind"], row["parameters.angle"], "+-", row["error"] * row["parameters.angle"])

# %%
# Stable up to the fold (solid), unstable behind it (dashed).
branch.plot("angle", "middle")

# %%
# Each point is a solution. This is the last one, which no real strip would stay in.
branch[-1].plot("ribbon")

# %%
# As a table.
branch.to_pandas()[["parameters.angle", "kind", "negative", "energy", "middle"]]
