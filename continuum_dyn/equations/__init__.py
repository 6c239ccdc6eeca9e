"""Equations of motion: a scene's structure comes in; the steps of its passes in motion go out."""
