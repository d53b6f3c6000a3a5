"""Multiple shooting: intervals integrated by Runge-Kutta steps."""
