"""What the user writes, checked and resolved."""
