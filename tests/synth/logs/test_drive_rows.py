"""The pressure along logged passes against the pressure histories of the drive."""

from __future__ import annotations

import numpy as np
import pytest

from plant_models.library.catalogue import load_position
from plant_models.valve_drive import ValveDrive
from synth.kernels.measured.drive_rows import Commands, drive_rows

POSITION = load_position("knp-5-bunch").position
TOUCH = POSITION.force.touch_pressure_kpa
DELAY_S, PERIOD_S, PARTS = 0.02, 0.1, 4


def driven(
    stage: list[int], settled: bool = False, released: ValveDrive | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Pressures at rows a tenth of a second apart, and mean overpressures between them."""
    n = len(stage)
    over, kpa = np.empty((n, PARTS)), np.empty(n)
    levels = np.asarray(POSITION.stage_pressures_kpa)
    commands = Commands(
        np.arange(n, dtype=np.float64) * PERIOD_S, np.array(stage), np.array([0, n]), 0, levels, DELAY_S, settled
    )  # fmt: skip
    valves = POSITION.pneumatics.valves(TOUCH)
    drive_rows(commands, valves, valves if released is None else released, 0, 1, over, kpa)
    return kpa, over


@pytest.mark.parametrize("way", [(0, 1, 2), (0, 2, 1), (0, 4, 0), (0, 3, 4)])
def test_commands_at_rest_follow_the_histories(way: tuple[int, int, int]) -> None:
    stage = [way[0]] * 5 + [way[1]] * 25 + [way[2]] * 25
    kpa, over = driven(stage)
    levels, drive = POSITION.stage_pressures_kpa, POSITION.pneumatics
    first = drive.respond(levels[0] + drive.dead_band_kpa, levels[way[1]], TOUCH)
    second = drive.respond(first.end_kpa, levels[way[2]], TOUCH)
    for history, at in ((first, 5), (second, 30)):
        since = np.arange(20, dtype=np.float64) * PERIOD_S - DELAY_S
        np.testing.assert_allclose(kpa[at + 1 : at + 20], history.pressure_kpa(since[1:]), atol=1e-9)
        edges = np.arange(1, 21, dtype=np.float64) * PERIOD_S - DELAY_S
        total = history.overpressure_integral(edges, TOUCH)
        np.testing.assert_allclose(PERIOD_S * over[at + 1 : at + 20].mean(axis=1), np.diff(total), atol=1e-9)


def test_settled_commands_pay_their_delay_whatever_the_drive_does() -> None:
    """The second command comes while the pressure still falls: it goes on at once, unless it must have been at rest."""
    stage = [0] * 3 + [4] * 20 + [3] + [2] * 20
    under_way, _ = driven(stage)
    at_rest, _ = driven(stage, settled=True)
    assert under_way[24] == pytest.approx(at_rest[24])
    assert at_rest[25] > under_way[25] + 15.0
    assert at_rest[-1] == pytest.approx(under_way[-1])


@pytest.mark.parametrize(("above", "edge"), [(2, -1.0), (3, 1.0)])
def test_a_released_drive_that_is_open_to_the_air_goes_on_to_zero(above: int, edge: float) -> None:
    """By the exponential of the exhaust, also where the dead band would have shut the valve, from either
    edge of the dead band above; and fills from there."""
    drive = POSITION.pneumatics
    stage = [0] * 5 + [above] * 10 + [2] * 5 + [0] * 45 + [2] * 15
    kpa, over = driven(stage, released=drive.valves(TOUCH)._replace(band_kpa=1e-3))
    assert kpa[:6] == pytest.approx(1e-3)
    top = POSITION.stage_pressures_kpa[2] + edge * drive.dead_band_kpa
    since = np.arange(45, dtype=np.float64) * PERIOD_S - DELAY_S - drive.release_delay_s
    expected = top * np.exp(-np.maximum(since, 0.0) / drive.exhaust_time_constant_s)
    np.testing.assert_allclose(kpa[20:65], np.maximum(expected, 1e-3), atol=1e-9)
    again = drive.respond(1e-3, POSITION.stage_pressures_kpa[2], TOUCH)
    edges = np.arange(1, 15, dtype=np.float64) * PERIOD_S - DELAY_S
    np.testing.assert_allclose(kpa[66:], again.pressure_kpa(edges), atol=1e-9)
    total = again.overpressure_integral(edges, TOUCH)
    np.testing.assert_allclose(PERIOD_S * over[66:-1].mean(axis=1), np.diff(total), atol=1e-9)
