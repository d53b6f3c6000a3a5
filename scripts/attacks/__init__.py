"""Attacks on ribbonopt: hostile scenes, studies, files, names, environments and kills; seeded."""
