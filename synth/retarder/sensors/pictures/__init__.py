"""Pictures of tables for point sensors."""
