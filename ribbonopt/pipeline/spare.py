"""How much finer a new mesh is than one solution needs, where neighbours are to be met on it."""

SPARE = 0.05  # of the error that a new mesh may leave: it shall serve the neighbours to come
