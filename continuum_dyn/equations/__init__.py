"""From a scene's structure to the steps of its passes in motion, and a scene's equations by name."""
