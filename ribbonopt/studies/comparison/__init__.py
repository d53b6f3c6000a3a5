"""One scene by every formulation and scheme, and run time against error."""
