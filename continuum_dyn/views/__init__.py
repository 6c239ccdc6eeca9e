"""Views: what shows a log to people. They read logs, never a running solver."""
