"""What a start before the entrance is worth."""
