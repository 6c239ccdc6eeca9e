"""Scenarios as data: an arm with its effects, what drives it over time, a study, a solver, expectations."""
