"""
A notebook with xarray and pandas
=================================

From a configuration to lines, a comparison and the log of a night, each array and column with its unit.

It needs `pip install 'retarder-synth[xarray]'`. The end of this page has it as a notebook for Jupyter.
"""

import matplotlib.pyplot as plt

import synth

config = synth.load_config()  # the built-in one; load_config("my.toml") reads a file
table = synth.tune("gondola-4-22t", target_m_s=3.0, config=config)
lines = synth.to_xarray(table)
lines[["lower_m_s", "upper_m_s"]].sel(path_m=[0.0, 10.0, 20.0])

# %%
# The upper lines over the path. xarray labels the axes by names and units in the dataset:

figure, axes = plt.subplots(figsize=(8, 4))
upper = lines.upper_m_s.dropna("stage", how="all")
drawn = upper.plot.line(x="path_m", ax=axes)
title = axes.set_title(table.id)

# %%
# The table beside the laws that it has to beat, on the same passes, with 95 % intervals. A ratio
# below 1 says that the table is better:

problem = synth.load_problem("gondola-4-22t", target_m_s=3.0, config=config)
measured = synth.compare_with_baselines(table, problem, passes=2000)
laws = synth.to_pandas(measured).set_index("controller")
figures = ["rms_m_s", "table_ratio", "table_ratio_low95", "table_ratio_high95"]
laws[figures].T.round(3)

# %%
# The log of a night. Here it is simulated; `load_passes` reads one from files. A point for each
# reading, with the stage that is commanded from it on:

night = synth.to_xarray(synth.log_passes(table, problem, passes=60))
readings, axes = plt.subplots(figsize=(8, 4))
shown = {"hue": "stage", "s": 4, "edgecolors": "none"}
points = night.plot.scatter(x="path_m", y="speed_m_s", ax=axes, **shown)

# %%
# How long the cuts took, s:

time_s = night.time_s.max("sample") - night.time_s.min("sample")
time_s.to_pandas().describe().to_frame("time_s").round(2)
