"""A roller: it carries a load across its rail and nothing else."""

from ribbonopt.scene.supports import LoadVector, Position, Support

ROLLER = Support(
    "roller",
    "the lab component x of the position is held; no force along y and z, no moment",
    (Position("x"), LoadVector("force", "yz"), LoadVector("moment")),
)
