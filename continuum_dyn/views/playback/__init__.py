"""Logs played back in rerun: from the log alone to a recording with its layout, and a viewer for it."""
