"""
Slow valves: known, and not known
=================================

What a valve delay costs if the table was made for it, and if the table was made for a faster valve.

A delay that the design knows costs little. A delay that it does not know costs more. So measure it.
"""

from dataclasses import replace

import matplotlib.pyplot as plt

import synth

problem = synth.load_problem("gondola-4-52t", target_m_s=3.0)
coarse = synth.Resolution(path_step_m=0.5, speed_step_m_s=0.04)


def with_delay(delay_s):
    """The problem with valves that open so late."""
    position = problem.plant.position
    pneumatics = replace(position.pneumatics, brake_delay_s=delay_s, release_delay_s=delay_s)
    return synth.Problem(replace(problem.plant, position=replace(position, pneumatics=pneumatics)), problem.aim)


def table_for(a_problem):
    """The table of a problem."""
    return synth.tabulate(synth.fit(synth.solve(a_problem, coarse)))


usual = table_for(problem)
delays, known, unknown = (0.05, 0.1, 0.2, 0.3, 0.4), [], []
for delay in delays:
    slower = with_delay(delay)
    known.append(synth.simulate(table_for(slower), slower, passes=4000).statistics.rms_m_s)
    unknown.append(synth.simulate(usual, slower, passes=4000).statistics.rms_m_s)

figure, axes = plt.subplots(figsize=(7, 4))
axes.plot(delays, known, "o-", label="table made for this delay")
axes.plot(delays, unknown, "s--", label="table made for 0.1 s")
axes.set(xlabel="delay of both valves, s", ylabel="rms error, m/s", ylim=(0, None))
axes.legend()
