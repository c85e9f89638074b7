"""The plant as a Markov chain: a grid, the states of the drive, and what leads where."""
