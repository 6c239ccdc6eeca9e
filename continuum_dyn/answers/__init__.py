"""What a log answers: how its motion settles, how far it lags behind its static path."""
