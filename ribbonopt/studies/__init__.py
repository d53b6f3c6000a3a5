"""Studies: loops over the path, each calling it with other scenes; nothing is solved here."""
