"""Pictures of point sensors."""
