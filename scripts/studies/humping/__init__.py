"""Studies of the whole hump: what trains come to, by accuracy, control, program of hump speeds, and place."""
