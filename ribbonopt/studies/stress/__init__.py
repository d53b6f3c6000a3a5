"""One scene under stress: what a solve comes to far from what it was made for."""
