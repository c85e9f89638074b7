"""The control computer of the hump: how fast it must be, how reliable it is, and what it pays."""
