"""A table book over a grid of cut classes, targets and conditions: planned, computed anywhere, resumed, bound."""
