"""Maps: a rectangle of two parameters that loci cut into regions, and the shapes in each."""
