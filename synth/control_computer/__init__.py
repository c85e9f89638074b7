"""The control computer of a hump: how fast it must be, how reliable, and what it pays."""
