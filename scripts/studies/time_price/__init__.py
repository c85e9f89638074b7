"""What a price of a second in the position costs in accuracy."""
