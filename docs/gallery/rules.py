"""
Beside rules of thumb
=====================

The table against two classical rules, each tuned for the same problem: a relay and the energy rule.

The bars are the rms error of the exit speed on the same passes. A whisker is a 95 % interval.
"""

import matplotlib.pyplot as plt

import synth

names, found = [], {"table": [], "relay": [], "energy rule": []}
for mass in (22, 52, 85):
    problem = synth.load_problem(f"gondola-4-{mass}t", target_m_s=4.0)
    table = synth.tune(f"gondola-4-{mass}t", target_m_s=4.0)
    names.append(f"{mass} t")
    found["table"].append(synth.simulate(table, problem, passes=4000).statistics)
    for law in synth.compare_with_baselines(table, problem, passes=4000):
        found[law.name].append(law.statistics)

figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
for place, (law, all_statistics) in enumerate(found.items()):
    at = [k + 0.27 * (place - 1) for k in range(len(names))]
    rms = [each.rms_m_s for each in all_statistics]
    ends = [
        [each.rms_m_s - each.rms_ci95_m_s[0] for each in all_statistics],
        [each.rms_ci95_m_s[1] - each.rms_m_s for each in all_statistics],
    ]
    axes.bar(at, rms, 0.25, yerr=ends, label=law)
axes.set(xticks=range(len(names)), xticklabels=names, ylabel="rms error at 4 m/s, m/s")
figure.legend(loc="outside upper right", ncols=3)
