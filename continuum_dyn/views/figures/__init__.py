"""Logs and answers come in, matplotlib figures go out."""
