"""The forms of a table: JSON, CSV, C, Structured Text."""
