"""Numbers with sources, each computed again: what this package can vouch for."""
