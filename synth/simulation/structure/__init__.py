"""The regulator and its plant as one block diagram of named parts, for a radar and for point sensors."""
