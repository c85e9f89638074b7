"""What a checkout has besides the product: scripts for the shell, and the studies. No wheel holds it."""
