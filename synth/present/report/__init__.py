"""The report of humped trains."""
