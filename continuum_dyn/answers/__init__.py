"""Logs come in, their figures go out: settling, ring-down, the lag and the loop of a ramp."""
