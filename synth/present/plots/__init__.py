"""Pictures of a tune: one figure a file, drawn with matplotlib's `Figure` alone (no pyplot, no global state).

Only this package imports matplotlib, so whoever draws imports it inside the function that needs it.
"""
