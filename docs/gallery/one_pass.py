"""
One pass, and the same pass with less friction
==============================================

Speed and commanded stage of one cut over the path, for three values of its friction.

The table knows nothing of the friction of a cut. It sees the speed, and the estimator in it learns from that.
"""

import matplotlib.pyplot as plt

import synth

problem = synth.load_problem("gondola-4-66t", target_m_s=3.0)
table = synth.tune("gondola-4-66t", target_m_s=3.0)

figure, (speed, stage) = plt.subplots(2, 1, sharex=True, figsize=(8, 6))
for friction in (0.7, 1.0, 1.3):
    one = synth.trace(table, problem, friction=friction, seed=1)
    speed.plot(one.path_m, one.speed_m_s, label=f"friction × {friction:g}: leaves with {one.exit_speed_m_s:.2f} m/s")
    stage.step(one.path_m, one.stage, where="post")
speed.set(ylabel="speed, m/s")
speed.legend()
stage.set(xlabel="path from the entrance, m", ylabel="commanded stage")
