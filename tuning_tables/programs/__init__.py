"""The rules of a controller, each stated once: run by Python, compiled by numba, printed as C99 and Structured Text.

`line_table` declares what a controller holds of a table with switching lines, `estimate` what it knows of a cut. The
rules: `decide` (which stage to command), `observe` (which speed to decide with), `alarms` (what is wrong with a cut),
`correct` (what the last exits teach). `aim_table` and `aim_speed` are those of the exit speed that a park position is
told, `passage_table`, `tracker` and `at_pulse` those of point sensors.
"""
