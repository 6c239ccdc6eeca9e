"""Logs and answers come in, figures and playbacks go out; nothing here reads a running solver."""
