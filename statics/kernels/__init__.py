"""From steps to passes that can be called: readable text, kept by its key, and machine code."""
