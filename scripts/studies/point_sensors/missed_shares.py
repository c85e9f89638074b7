"""What it costs, and what it saves where a sensor is dead, that a design counts passages as not heard."""

from __future__ import annotations

from dataclasses import replace

from plant_models import PointSensors
from scripts.studies.point_sensors.layouts import planned
from scripts.studies.point_sensors.rows import MissedRow
from scripts.studies.point_sensors.sensor_faults import DeadSensor, SensorFault, together
from scripts.studies.point_sensors.sensor_table import AXLES, tabulated
from scripts.studies.point_sensors.sites import Site
from scripts.studies.point_sensors.worth import tuned_at
from synth.problem.resolution import Resolution
from synth.retarder.sensors.candidate_places import LayoutCase
from synth.retarder.sensors.layout_plan import LayoutProblem
from synth.simulation.exit_statistics import ExitStatistics, exit_statistics
from synth.simulation.passage_controller import of_table
from synth.simulation.random_passes import RandomPasses


def missed_row(
    site: Site, axles: str, sensors: int, share: float, resolution: Resolution, passes: RandomPasses
) -> MissedRow:
    """The planned layout of `sensors`, that behind the exit with them, when a `share` of passages is counted as lost.

    Every sensor that decides is dead once, on the same passes, by the table's tracker.
    """
    kind = replace(PointSensors((0.0,), axles=AXLES[axles]), missed_share=share)
    problem = LayoutProblem((LayoutCase(site.plant, (site.aim,)),), kind, resolution)
    (places,) = planned(problem, [sensors - 1])
    made = tabulated(site, tuned_at(problem, places))
    controller, draws = of_table(made.table, tracking=True), made.loop.draws(passes)

    def run(*faults: SensorFault) -> ExitStatistics:
        return exit_statistics(made.loop.run(controller, draws, together(made.loop.sensors, faults)), site.target_m_s)

    whole, dead = run(), [run(DeadSensor(sensor)) for sensor in range(len(places))]
    worst = max(range(len(dead)), key=lambda sensor: dead[sensor].rms_m_s)
    return MissedRow(
        case=site.title,
        axles=axles,
        sensors=sensors,
        missed_share=share,
        predicted_m_s=made.tuned.rms_m_s,
        rms_m_s=whole.rms_m_s,
        rms_ci95_m_s=whole.rms_ci95_m_s,
        worst=worst,
        dead_rms_m_s=dead[worst].rms_m_s,
        dead_rms_ci95_m_s=dead[worst].rms_ci95_m_s,
        most_stalled=max(each.stalled for each in dead),
        most_stalled_ci95=max(each.stalled_ci95 for each in dead),
    )
