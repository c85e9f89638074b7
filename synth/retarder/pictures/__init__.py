"""Pictures of tables and of their loops: one figure a file, drawn with `Figure` alone (no pyplot, no global state).

Whoever draws imports them inside the function that needs one.
"""
