"""Searches for equilibria in compiled code that knows no scene and calls its passes by address."""
