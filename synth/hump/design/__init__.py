"""The design test of a hump: a bad runner ahead of a good one ahead of a bad one, to tracks that part."""
