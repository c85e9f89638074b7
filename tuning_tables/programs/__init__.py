"""The rules of a controller, each stated once: Python runs them, numba compiles them, C99 and Structured Text are printed.

`line_table` declares what a controller holds of a table with switching lines, `estimate` what it knows of a cut. The
rules: `decide` (which stage to command), `observe` (which speed to decide with), `alarms` (what is wrong with a cut).
"""
