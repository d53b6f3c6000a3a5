"""A solution: the frozen result of one solve, and its trajectory along the ribbon."""
