"""Both units in a loop, as an importer runs them: the controller first, then the position with its stage."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from synth.retarder.fmi.controller_unit import controller_unit
from synth.retarder.fmi.description import FMI_3, Interface
from synth.retarder.fmi.position_unit import position_unit
from synth.simulation.closed_loop import TableController, close_loop
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import random_passes
from tests.controller_code.fmi.importer import Imported
from tuning_tables.export_names import RETARDER
from tuning_tables.table import ControllerTable
from tuning_tables.table_book import TableBook

WIRES = ("path_m", "measured_m_s", "mean_overpressure_kpa", "pressure_kpa", "at_rest")
STANDS = 2
TOLERANCE = 1e-9
"""m/s and s. Both compute the same in double precision, in another order: 4e-13 were measured in 1 000 passes."""


@dataclass(frozen=True, eq=False)
class LoopOfUnits:
    """How passes ended, by the units and by the simulator: n of each."""

    exit_speed_m_s: NDArray[np.float64]
    transit_time_s: NDArray[np.float64]
    switchings: NDArray[np.int64]
    stalled: NDArray[np.bool_]
    lost: int
    simulated: ExitSample


def units_of(plant: Plant, table: ControllerTable, interface: Interface = FMI_3) -> tuple[bytes, bytes]:
    """Both units, controller and position."""
    controller = controller_unit(TableBook((table,)), RETARDER)
    return controller.archive(interface), position_unit([plant], RETARDER).archive(interface)


def loop_of_units(
    units: tuple[bytes, bytes], plant: Plant, table: ControllerTable, seed: int, count: int, folder: Path,
    imported: type[Imported] = Imported,
) -> LoopOfUnits:  # fmt: skip
    """`count` passes of `plant` under `table` by two `units` (`units_of`), which may hold other tables and cuts too.

    They are told what the simulator draws for cut, entry and clock; noise and friction along the path they draw.
    """
    loop, passes = close_loop(plant, len(table.stages)), random_passes(seed, 0, count)
    draws, entry_m_s = loop.draws(passes), plant.entry.speed_m_s(passes.entry_u)
    simulated = loop.run(TableController(table), draws)
    controller, position = units
    ends, lost = [], 0
    with imported(position, folder / "position") as there, imported(controller, folder / "controller") as here:
        for i in range(count):
            there.begin(
                **cut_of(plant, len(there.get("axle_offsets_m"))),
                entry_speed_m_s=float(entry_m_s[i]),
                friction_factor=float(draws.cut_factor[i]),
                resistance_n_per_kn=float(draws.resistance_n_kn[i]),
                first_sample_s=float(draws.first_sample_s[i]),
                seed=seed,
                pass_number=i,
            )
            here.begin(**choice_of(plant, table), initial_stage=plant.approach.initial_stage)
            switchings, unheard = run_pass(here, there)
            lost += unheard
            ends.append((there.get("exit_speed_m_s"), there.get("pass_s"), switchings, there.get("end") == STANDS))
    speed, time, commands, stalled = (np.array(column) for column in zip(*ends, strict=True))
    return LoopOfUnits(speed, time, commands, stalled, lost, simulated)


def require_equal(found: LoopOfUnits) -> None:
    """Fail unless every pass ended as in the simulator, with as many commands."""
    inside = found.simulated
    np.testing.assert_array_equal(found.switchings, inside.switchings)
    np.testing.assert_array_equal(found.stalled, inside.stalled)
    np.testing.assert_allclose(found.exit_speed_m_s, inside.exit_speed_m_s, rtol=0.0, atol=TOLERANCE)
    np.testing.assert_allclose(found.transit_time_s, inside.transit_time_s, rtol=0.0, atol=TOLERANCE)


def choice_of(plant: Plant, table: ControllerTable) -> dict[str, Any]:
    """What chooses the table, as parameters of the controller."""
    number = table.cut.category_number or plant.cut.category_number
    told = {} if number is None else {"category": number}
    return {**told, "axles": plant.cut.axles, "commanded_m_s": float(np.float32(table.target_speed_m_s))}


def cut_of(plant: Plant, room: int) -> dict[str, Any]:
    """The cut as parameters of the position."""
    cut = plant.cut
    offsets = (*cut.axle_offsets_m, *(0.0,) * (room - cut.axles))
    return {"mass_t": cut.mass_t, "axles": cut.axles, "axle_offsets_m": offsets}


def run_pass(controller: Imported, position: Imported) -> tuple[int, int]:
    """One pass of units that have begun: commands that were given, and readings that were lost."""
    step_s, sample, switchings, lost = position.step_s, 0, 0, 0
    while position.get("end") == 0:
        before = controller.get("stage")
        controller.set(**{name: position.get(name) for name in WIRES})
        lost += position.get("measured_m_s") < 0.0
        controller.step(step_s * sample, step_s)
        switchings += controller.get("stage") != before
        position.set(stage=controller.get("stage"))
        position.step(step_s * sample, step_s)
        sample += 1
    return switchings, lost
