"""Mistakes of scenario files: found part by part, and said in words."""
