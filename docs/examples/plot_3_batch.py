"""
Solve a batch, and read it with pandas
======================================

Thirty-five arches between clamps that stand closer and closer, one of them turned: a table.
"""

# %%
# A study is a file that names a scene and what is swept over it.
from pathlib import Path
from tempfile import mkdtemp

from ribbonopt import load_study, run_batch

folder = Path(mkdtemp())
(folder / "arches.yaml").write_text(
    """
name: arches
scene:
  name: arch
  law: {type: variational, delta: 0.1}
  parameters: {distance: 0.8, turn: 0}
  boundary:
    start: {support: clamped, position: [0, 0, 0], directors: identity}
    end: {support: clamped, position: [0, 0, distance], directors: {turns: [{y: turn}]}}
  tolerance: 1e-6
sweep:
  grid:
    parameters.distance: {from: 0.6, to: 0.9, count: 7}
    parameters.turn: [-0.4, -0.2, 0, 0.2, 0.4]
""",
    encoding="utf-8",
)
study = load_study([folder / "arches.yaml"])
print(study.count, "ribbons")

# %%
# Workers solve it, each ribbon starting from its neighbour.
from ribbonopt import Batch

batch = Batch.of(study, run_batch(study))
batch

# %%
# The rows as a table: inputs, loads, strains, energy, the error, and how each was solved.
rows = batch.to_pandas()
rows[["parameters.distance", "parameters.turn", "verified", "energy", "error", "seconds"]].head()

# %%
# From here on it is pandas: the energy at each distance (down) and turn (across).
rows.pivot(index="parameters.distance", columns="parameters.turn", values="energy").round(3)

# %%
# Any two columns as a scatter.
batch.plot("distance", "energy")
