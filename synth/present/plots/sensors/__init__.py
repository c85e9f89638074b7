"""Pictures of point sensors: their tables, and where they stand."""
