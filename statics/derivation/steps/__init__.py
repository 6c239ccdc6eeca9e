"""The forces of a scene come in; its passes along the chain go out, one step a pass."""
