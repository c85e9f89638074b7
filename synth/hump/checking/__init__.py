"""What a hump file says, and what is likely wrong in it though nothing forbids it."""
