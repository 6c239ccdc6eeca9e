"""A scenario and its run come in; warnings about valid but unusual values go out."""
