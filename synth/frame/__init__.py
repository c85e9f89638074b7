"""What every command stands on: what can go wrong, and the directory of its results, which nobody else changes."""
