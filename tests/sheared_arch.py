"""The sheared arch: both ends clamped, shortened to .6875, the far end moved across along d2."""

from ribbonopt.scene import Scene, loads_scene

SADOWSKY = "{type: sadowsky}"

#: loads near those of the arch that is symmetric under half a turn about d1, by shear
NEAR = {
    0.1: ([0.0, 16.64, -43.71], [-7.905, 6.522, 5.982]),
    0.3: ([0.0, 67.98373, -17.63267], [-26.01431, -1.32271, 18.36979]),
    0.38: ([0.0, 84.09953, -10.89217], [-30.97873, -4.01012, 18.21611]),
}


def arch(law: str, shear: float, near: tuple[list[float], list[float]], weight: str = "") -> Scene:
    """Return the scene of an arch, from loads near those at its start, under a force per length."""
    loads = f"loads: {{force: {{{weight}}}}}" if weight else ""
    return loads_scene(
        f"""
        name: arch
        law: {law}
        boundary:
          start: {{support: clamped, position: [0, 0, 0], directors: identity}}
          end: {{support: clamped, position: [0, {shear}, 0.6875], directors: identity}}
        guess: {{force: {near[0]}, moment: {near[1]}}}
        tolerance: 1e-8
        {loads}
        """
    )
