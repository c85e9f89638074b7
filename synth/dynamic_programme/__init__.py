"""The stochastic dynamic programme: solved backward, its policies evaluated exactly."""
