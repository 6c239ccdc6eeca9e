"""Helpers that know nothing of arms: interruption, stages, lazy names, checked dataclasses."""
