"""The study `criteria`: other criteria than the mean square."""
