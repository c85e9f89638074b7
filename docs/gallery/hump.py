"""
How fast a hump can hump
========================

Cars an hour and catch-ups over the time that is left between cuts, on the same hundred trains.

The hump speed is planned so that each cut clears every switch in time, and with a margin. A smaller margin brings more
cars an hour and more catch-ups. The command `hump capacity` searches the margin at which an allowed share of catch-ups
is reached.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt

import synth

margins_s, cars, shares = (2.0, 1.0, 0.5, 0.0, -0.5), [], []
for margin_s in margins_s:
    with TemporaryDirectory() as folder:
        trial = Path(folder, "trial.toml")
        trial.write_text(f'hump = "large"\n[hump_speed]\nleast_s = {margin_s}\n', encoding="utf-8")
        humped = synth.hump_trains(synth.load_trial(trial), trains=100)
    figures = {each.name: each for each in humped.figures}
    cars.append(figures["cars_per_hour"].told.value)
    shares.append(100.0 * figures["catch_ups"].told.value)

figure, axes = plt.subplots(figsize=(7, 4))
axes.plot(cars, shares, "o-")
for margin_s, x, y in zip(margins_s, cars, shares, strict=True):
    axes.annotate(f"{margin_s:g} s", (x, y), textcoords="offset points", xytext=(6, 6))
axes.set(xlabel="cars an hour", ylabel="cuts that caught up, %")
