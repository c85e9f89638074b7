"""What becomes of a table on another plant than it was tuned for: wrong parameters, worn parts, faulty sensors."""
