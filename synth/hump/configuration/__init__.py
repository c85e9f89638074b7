"""The configuration of a hump trial: trains, hump speeds, exit speeds, positions."""
