"""How large, how small and how many: every limit on what a user may ask, each with its reason.

Sizes are limited twice. As they are written, in the scene's own units, so that products, squares
and cubes of a few of them stay finite (`LARGEST`, `SMALLEST`); that is generous to any units, from
graphene in metres (3e-10 thick) to cables of kilometres. And in units L = 1, Dw = 1, in which all
is solved (`REACH` and what follows from it): double precision knows sixteen digits, and a solution
should have ten. Counts are limited where more would run for days or could not be told from a slip
of the keyboard; what they need of memory is looked at apart, in `ribbonopt.attempt.afford`.
"""

from __future__ import annotations

#: any number of a scene as it is written; its seventh power is finite, and that of the least normal
LARGEST, SMALLEST = 1e30, 1e-30

#: lengths in units L = 1, and their inverses: positions keep ten digits of the length at 1e6 L
REACH = 1e6
#: strains and moments: a ribbon of 1 km bent to a radius of 1 mm has 1e6
STRAIN = MOMENT = REACH
#: a force n acts on lengths 1 / sqrt(n); a load per length on the cube root
FORCE, FORCE_PER_LENGTH = REACH**2, REACH**3
#: widths along the ribbon, in units of its own: none is a million times another
WIDTH, NARROW = 1e3, 1e-6
#: width in units L = 1 of a law with layers as wide: it is Sadowsky's but for its square
NARROWEST = 1e-5
#: radians in all; a frame keeps ten digits. 1e5 is 16,000 turns
ANGLE = 1e5
#: stretch of a ribbon whose ends are held apart: its stretch is linear, and small
STRETCH = 0.1
#: ratios of stiffnesses, and of what smooths a law to the law
RATIO, SMOOTHING = 1e12, 1e6

HALF_TWISTS = 1_000  # of a closed band, whose writhe is a sum over all pairs of its pieces
INTERVALS = 20_000  # a million unknowns at degree 6: minutes a solve, 2 GB
STEPS = 100  # of Runge-Kutta in one interval, each of which is written out; intervals are not
ITERATIONS = 100_000  # of a solver; those that lead somewhere take less than a hundred
STARTS = 10_000  # each is a solve: some hours
SEED = 2**128 - 1  # as many bits as numpy's seeds have
POINTS = 1_000_000  # of a branch
BRANCHES = 100  # how often a branch may leave a branch
MODES = 100  # of vibrations: as many as a mesh of 20 elements may tell
COUNTED = 1_000  # special points of one kind at which a stage may end

#: items of one list or mapping of a scene, by its key; `ITEMS` for all others
ITEMS = 10_000
ROWS = 200  # of a table along the ribbon: each costs operations at every point of a mesh
ITEMS_OF = {"also": 100, "switching": 100, "turns": 1_000, "continuation": 100, "record": 1_000}
#: each is a phase of its own, with equations of its own
ITEMS_OF |= {"points": 100, "supports": 100}

RIBBONS = 1_000_000  # of a study, all of which are put in order before the first is solved
VALUES = 10**12  # of one key of a study, which are made one by one
SECONDS = 1e6  # that one ribbon may take: eleven days, and less than any clock refuses to wait for
JOBS = 1_000  # processes on one machine
REPEATS = 10_000  # solves that one number of a benchmark is the median of
