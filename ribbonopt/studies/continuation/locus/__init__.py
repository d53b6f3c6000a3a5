"""Loci of special points of branches in two parameters, as equations that the walk follows."""
