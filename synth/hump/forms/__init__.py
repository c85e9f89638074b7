"""A hump in other forms than the file that it came from: rows of a table, TOML."""
