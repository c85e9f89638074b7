"""
Switching lines of one table
============================

The lines of every stage over the path, with simulated cuts that cross them.

A controller holds the stage in force between its two lines. Below the lower line it goes a stage down, above the upper
line a stage up. The table of this example is for a loaded gondola of 52 t that should leave with 3 m/s.
"""

import synth

problem = synth.load_problem("gondola-4-52t", target_m_s=3.0)
table = synth.tune("gondola-4-52t", target_m_s=3.0)
lines = synth.plot_table(table, problem)

# %%
# Three cuts, speed and pressure over the path and over time; below, the exit speeds of 5000 cuts:

passes = synth.plot_passes(table, problem)
print(table)
