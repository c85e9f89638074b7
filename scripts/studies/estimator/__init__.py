"""The studies of the estimator: what it gains, at which spreads of friction, and what it costs where it is wrong."""
