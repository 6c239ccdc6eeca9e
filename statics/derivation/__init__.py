"""Derivation: a scene's structure comes in; the steps of its passes, as sympy expressions, go out."""
