"""What can go wrong: with the input, with the machine, and what nobody foresaw."""
