"""Small vibrations about an equilibrium: inertia, eigenvalues, what moves at no cost, bands."""
