"""Study: the controllers that a manufacturer with a modern computer would build, beside tables."""
