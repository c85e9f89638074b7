"""The regulator with point sensors as a python-control system: one step of it is one pulse pair.

Motion and drive are those of `control_system.nominal_loop`, continuous in time. The impulse element quantises by path,
so the regulator has no sampling period: it is a discrete-time system of unspecified period (`dt=True`), and times are
inputs of it. `passage_response` closes the loop.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from plant_models.stage_regulator import Actuator, stage_locked_actuator
from synth.kernels.loop.passage_pulses import read_speed_m_s
from synth.kernels.loop.passage_regulator import DECIDED, believed_passage, outcome_of, stage_at_passage
from synth.simulation.passage_controller import PassageController
from synth.simulation.passage_loop import PassageLoop
from tuning_tables.programs.tracker import TRACKER, begin_cut

if TYPE_CHECKING:
    from control import NonlinearIOSystem

STAGE, MODE, RESTS_S, BELIEVED = range(4)
"""Places in the regulator's state; from `BELIEVED` on the six numbers of the tracker."""

TRACKED = len(TRACKER.members)


def passage_regulator_system(loop: PassageLoop, controller: PassageController) -> NonlinearIOSystem:
    """The regulator as a discrete-time system of one step a pulse pair; it begins as `passage_regulator_start`.

    Inputs: `source`, which of the pulses heard; `time`, of the second pulse, s; `over_base`, time from the first pulse,
    s (true; it is quantised here); `since`, time since the pulse pair before, s. Output: the commanded stage. States:
    stage, resting mode (index of `Actuator`), time from which on the last transient has ended, and the tracker's.
    """
    import control  # start-up: python-control only where it is needed

    actuator, law = passage_actuator(loop, controller), controller.rule
    pulses, period = loop.pulses_of(controller), loop.sensors.scan_period_s

    def heard(x: Any, u: Any) -> tuple[int, NDArray[np.float32]]:
        source, time, over_base, since = int(u[0]), float(u[1]), float(u[2]), float(u[3])
        known, stage = np.array(x[BELIEVED:], dtype=np.float32), int(x[STAGE])
        read, passage = float(read_speed_m_s(pulses, over_base, 0.0)), int(pulses.number[source])
        if controller.tracks:
            sensor = int(pulses.sensor[source])
            passage = believed_passage(law, known, sensor, since, read)
        if outcome_of(law, passage, time - 0.5 * over_base >= float(x[RESTS_S])) == DECIDED:
            stage = stage_at_passage(law, passage, stage, read)
        return stage, known

    def next_state(t: float, x: Any, u: Any, params: dict[str, float]) -> list[float]:
        stage, known = heard(x, u)
        mode, rests_s = int(x[MODE]), float(x[RESTS_S])
        if stage != int(x[STAGE]):
            mode, scans = actuator.change(mode, stage)
            rests_s = float(u[1]) + scans * period
        return [float(stage), float(mode), rests_s, *known.tolist()]

    return control.nlsys(
        next_state,
        lambda t, x, u, params: [heard(x, u)[0]],
        inputs=["source", "time", "over_base", "since"],
        outputs=["stage"],
        states=["stage", "mode", "rests", *(f"believed{i}" for i in range(TRACKED))],
        dt=True,
        name="passage_regulator",
    )


def passage_regulator_start(loop: PassageLoop, controller: PassageController) -> NDArray[np.float64]:
    """The state of `passage_regulator_system` before the first pulse: at rest as the plant has it."""
    stage, known = loop.plant.approach.initial_stage, np.zeros(TRACKED, dtype=np.float32)
    begin_cut(known)
    return np.array([stage, passage_actuator(loop, controller).mode_of(stage), -np.inf, *known], dtype=np.float64)


def passage_actuator(loop: PassageLoop, controller: PassageController) -> Actuator:
    """Modes and chains for as many stages as the controller has, counted in scans."""
    return stage_locked_actuator(loop.plant.position, loop.sensors, controller.stages - 1, 1)
