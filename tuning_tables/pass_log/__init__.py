"""Measured passes of a retarder position: what a controller logs, as a value and as files."""
