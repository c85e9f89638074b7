"""The automaton of the drive: what it says of a period is what the drive does, up to interpolation in pressure."""

from __future__ import annotations

import numpy as np
import pytest

from plant_models import Plant
from plant_models.valve_drive import drive_on, wait_after_command
from synth.solver.any_time.drive_modes import COMMANDS, drive_modes, pressure_grid


def test_every_period_is_that_of_the_drive(plant: Plant) -> None:
    modes = drive_modes(plant, 20.0, 4)
    stages, pressure = plant.position.stage_pressures_kpa, modes.pressure_kpa
    assert modes.waits_s == pytest.approx([0.0, 0.22, 0.12, 0.02])
    assert {(int(k), bool(r)) for k, r in zip(modes.stage, modes.rests, strict=True)} >= {(k, True) for k in range(3)}
    for m in range(len(modes.stage)):
        for a, command in enumerate(COMMANDS):
            if not modes.allowed[m, a]:
                continue
            old, new = stages[modes.stage[m]], stages[modes.stage[m] + command]
            p, wait, early = drive_on(pressure[m], modes.waits_s[modes.wait[m]], old, 0.02, modes.drive)
            p, wait, late = drive_on(p, wait_after_command(p, wait, old, new, modes.drive), new, 0.08, modes.drive)
            assert modes.overpressure_kpa[m, a].mean() * 0.1 == pytest.approx(early + late, abs=1e-9)
            reached, weight = modes.target[m, a], modes.weight[m, a]
            assert weight @ pressure[reached] == pytest.approx(p, abs=1e-9)
            assert weight.sum() == pytest.approx(1.0)
            used = weight != 0.0
            assert (modes.stage[reached[used]] == modes.stage[m] + command).all()
            still = modes.waits_s[modes.wait[reached[used]]]
            assert (modes.rests[reached[used]] | (np.abs(still - wait) < 1e-9)).all()


def test_interpolation_is_cubic_and_stays_within_its_segment(plant: Plant) -> None:
    grid = pressure_grid(plant.position, 2, 12.0)
    for p in np.linspace(15.0, 285.0, 200):
        nodes, weight = grid.weights(float(p))
        if len(nodes) == 4:
            assert weight @ grid.nodes_kpa[nodes] ** 3 == pytest.approx(p**3, rel=1e-9)
        between = (grid.breaks > nodes.min()) & (grid.breaks < nodes.max())
        assert not between.any()
