"""The path: a scene's start, solver, phases, mesh and checks, walked once."""
