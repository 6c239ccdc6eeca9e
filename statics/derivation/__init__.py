"""From a scene's structure to the steps of its passes, as sympy expressions."""
