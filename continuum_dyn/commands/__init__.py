"""Command lines come in, answers are printed; large packages are imported only when needed."""
