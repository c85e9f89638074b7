"""New tables from measured passes, and what they gain."""
