"""Pictures of point sensors: where they stand, and what their tables do."""
