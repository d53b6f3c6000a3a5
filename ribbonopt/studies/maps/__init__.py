"""Maps: a rectangle of two parameters, cut by loci into regions, in each of which shapes are counted."""
