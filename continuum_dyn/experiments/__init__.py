"""Scenarios come in and are run many times; tables of what the runs show go out."""
