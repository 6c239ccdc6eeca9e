"""A scenario and its run come in; words about what is legal but odd go out, one sentence or two for each."""
