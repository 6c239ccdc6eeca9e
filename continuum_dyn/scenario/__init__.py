"""Scenario files come in; scenarios, checked, go out."""
