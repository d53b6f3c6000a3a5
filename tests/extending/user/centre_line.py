"""The centre line as text."""

import numpy as np


class CentreLine:
    name, files = "centre line", ("centre.txt",)

    def write(self, solution, folder):
        s = np.linspace(*solution.scene.interval, 11)
        np.savetxt(folder / "centre.txt", solution.sample(s, "r"))
