"""The checker's own reading of tables for point sensors."""
