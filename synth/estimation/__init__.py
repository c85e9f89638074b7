"""Tables for the estimated speed: design, trim, prediction."""
