"""
What an estimator in the table brings
=====================================

The rms error with lines for the measured speed, and with lines for a speed that the table estimates.

The estimator is a small filter in the exported code. It smooths the radar and learns the friction of the cut while it
brakes.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt

import synth

masses, with_estimator, without = (22, 52, 66), [], []
for mass in masses:
    name = f"gondola-4-{mass}t"
    problem = synth.load_problem(name, target_m_s=3.0)
    with TemporaryDirectory() as folder:
        plain = Path(folder, "plain.toml")
        plain.write_text("regulator.estimator = false\n", encoding="utf-8")
        measured = synth.tune(name, 3.0, plain)
    without.append(synth.simulate(measured, problem, passes=10_000).statistics.rms_m_s)
    with_estimator.append(synth.simulate(synth.tune(name, 3.0), problem, passes=10_000).statistics.rms_m_s)

figure, axes = plt.subplots(figsize=(7, 4))
places = range(len(masses))
axes.bar([place - 0.2 for place in places], without, 0.4, label="measured speed")
axes.bar([place + 0.2 for place in places], with_estimator, 0.4, label="estimated speed")
axes.set(xticks=places, xticklabels=[f"{mass} t" for mass in masses], ylabel="rms error, m/s", title="Target 3 m/s")
axes.legend()
