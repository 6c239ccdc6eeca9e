"""Equations of motion in compiled code that knows no scene and calls its passes by address."""
