"""Many runs at once: from a scenario to what it costs."""
