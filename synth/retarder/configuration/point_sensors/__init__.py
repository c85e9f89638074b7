"""The section [sensors] of a configuration: point sensors along the position."""
