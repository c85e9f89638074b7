"""
Exit speeds of 20 000 cuts
==========================

How exit speeds spread, and how that changes with the mass of the cut.

Heavy cuts saturate the brake more often. Their spread has a tail of cuts that leave too fast although the brake is full
on. No table can hold them.
"""

import matplotlib.pyplot as plt
import numpy as np

import synth

figure, axes = plt.subplots(figsize=(8, 4))
edges = np.arange(2.85, 3.8, 0.02)
for name in ("gondola-4-22t", "gondola-4-52t", "gondola-4-85t"):
    problem = synth.load_problem(name, target_m_s=3.0)
    passes = synth.simulate(synth.tune(name, target_m_s=3.0), problem, passes=20_000, seed=1)
    speeds, weights = passes.sample.exit_speed_m_s, passes.sample.weight
    axes.hist(speeds, edges, weights=weights, density=True, histtype="step", label=name)
    print(name, passes)
axes.set(xlabel="exit speed, m/s", ylabel="density, 1/(m/s)", yscale="log", title="Target 3 m/s")
axes.legend()
