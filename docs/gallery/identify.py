"""
Numbers of a position from its log
==================================

Three hundred logged passes, and what they say of the position.

The log is simulated, so the true numbers are known: an interval should hold its number in 95 of 100 logs.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt

import synth
from tuning_tables.pass_log import write_log

problem = synth.load_problem("gondola-4-66t", target_m_s=3.0)
table = synth.tune("gondola-4-66t", target_m_s=3.0)
with TemporaryDirectory() as folder:
    write_log(synth.log_passes(table, problem, passes=300), Path(folder, "passes.csv"))
    passes = synth.load_passes(folder)
found = synth.identify(passes)

figure, axes = plt.subplots(figsize=(8, 5))
shown = [each for each in found.findings if each.before]
for row, each in enumerate(shown):
    low, high = (end / each.before for end in each.interval)
    axes.plot((low, high), (row, row), "-", color="C0", linewidth=3)
axes.axvline(1.0, color="black", linewidth=0.8)
axes.set(yticks=range(len(shown)), yticklabels=[each.key for each in shown], xlabel="identified / true")
figure.tight_layout()
