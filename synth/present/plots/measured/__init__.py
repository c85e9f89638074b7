"""Pictures of measured passes."""
