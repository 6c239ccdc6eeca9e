"""Independent routes to the same answers: the exact rod, and the paper's printed equations."""
