"""
Where it snaps, as two numbers vary
===================================

A strip bowed between two clamps snaps when one of them is turned far enough against the bow. How
far, depends on how near the clamps stand: the fold of one branch is followed in a second number.
"""

# %%
# `parameter` is a pair: branches move the first, the fold is followed in the second.
from ribbonopt import Branch, Continuation, loads_scene

scene = loads_scene("""
name: arch
law: {type: kirchhoff, B2: 1, B3: 2}
parameters: {angle: 0, shortening: 0.1}
labels: {angle: "angle of the clamp (degrees)"}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0, 1 - shortening], directors: {turns: [{y: angle*deg}]}}
guess: {force: [0, 0, -42], moment: [0, 4, 0]}
states: planar
tolerance: 1e-8
continuation:
  parameter: [parameters.angle, parameters.shortening]
  of: fold
  between: [0, 90]
  to: [0.02, 0.4]
""")
branch = Branch.of(Continuation(scene))
branch

# %%
# The branch at a shortening of 0.1 goes up to its fold; from there the locus goes both ways. Above
# the line the strip has only one stable shape, that of the other side.
branch.plot("shortening", "angle")

# %%
# Each point of the locus is a verified solution, and its angle has a bar (relative). Shooting of
# order 8 gives 64.3483022372 degrees at 0.4.
row = branch.rows[-1]
row["parameters.shortening"], row["parameters.angle"], row["error"]

# %%
# Nearly flat, the angle is 1.78177604115671 times the square root of the shortening.
branch.to_pandas()[["parameters.shortening", "parameters.angle", "of", "kind", "error"]]
