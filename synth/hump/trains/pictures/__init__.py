"""Pictures of humped trains."""
