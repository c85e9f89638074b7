"""
What the spread of friction costs
=================================

The rms error of the best table for each spread of the friction from cut to cut.

The spread is the number that yards know least. The grid of this example is coarse, which moves the error by some per
cent and not the shape of the curve.
"""

from dataclasses import replace

import matplotlib.pyplot as plt

import synth

problem = synth.load_problem("gondola-4-66t", target_m_s=3.0)
coarse = synth.Resolution(path_step_m=0.5, speed_step_m_s=0.04)
spreads, low, rms, high = (0.05, 0.10, 0.15, 0.20, 0.25), [], [], []
for spread in spreads:
    friction = replace(problem.plant.friction, common_cv=spread)
    other = synth.Problem(replace(problem.plant, friction=friction), problem.aim)
    table = synth.tabulate(synth.fit(synth.solve(other, coarse)))
    statistics = synth.simulate(table, other, passes=4000).statistics
    rms.append(statistics.rms_m_s)
    low.append(statistics.rms_ci95_m_s[0])
    high.append(statistics.rms_ci95_m_s[1])

figure, axes = plt.subplots(figsize=(7, 4))
axes.plot(spreads, rms, "o-")
axes.fill_between(spreads, low, high, alpha=0.3, label="95 % interval")
axes.set(xlabel="coefficient of variation of the friction", ylabel="rms error, m/s", ylim=(0, None))
axes.legend()
