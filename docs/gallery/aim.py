"""
Which exit speed reaches the standing cars softly
=================================================

Exit speeds of a park position over the free distance to the standing cars, for cuts of one, two and ten cars.

The table keeps the required probability that a cut couples too fast. A longer cut is known better, so it may go faster.
"""

import matplotlib.pyplot as plt
import numpy as np

import synth
from tuning_tables.aim import aim_exit_speed

tables = synth.aim_tables(synth.load_aim(passes=2000))
table = tables.select(1, measured=False)

free_m = np.arange(20.0, 500.0, 10.0)
figure, axes = plt.subplots(figsize=(7, 4))
for cars in (1, 2, 10):
    speeds = [aim_exit_speed(table, cars=cars, free_distance_m=float(each)) for each in free_m]
    label = f"{cars} cars" if cars > 1 else "1 car"
    axes.plot(free_m, [np.nan if each is None else each for each in speeds], label=label)
axes.set(xlabel="free distance, m", ylabel="exit speed, m/s", title="The lightest category")
axes.legend()
