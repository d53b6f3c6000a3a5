"""The ends of a ribbon: what may be prescribed there, as conditions."""
