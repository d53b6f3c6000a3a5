"""Before anything is solved: whether the conditions determine an equilibrium."""
