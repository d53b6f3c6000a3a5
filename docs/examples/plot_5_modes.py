"""
How an arch vibrates
====================

Natural frequencies and shapes of small vibrations about an equilibrium, in its plane and out of it.
"""

# %%
# A strip bowed between two clamps, and its four lowest frequencies, in units of
# sqrt(Dw / (rho L^4)), rho the mass per length. Each has a relative bar.
from ribbonopt import loads_scene, solve

scene = loads_scene("""
name: arch
law: {type: kirchhoff, B2: 1, B3: 2}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0, 0.9], directors: identity}
guess: {force: [0, 0, -42], moment: [0, 4, 0]}
tolerance: 1e-9
""")
arch = solve(scene)
modes = arch.modes(count=4)
for omega, error in zip(modes.frequencies, modes.errors, strict=True):
    print(f"{omega:.6f}  relative bar {error:.0e}")

# %%
# How much of the kinetic energy is in the plane: 1 or 0 here.
modes.in_plane.round(6)

# %%
# The shapes, swept from one side to the other.
arch.plot("modes")
