"""The conditions that the tables of a tune are tried in: how the true plant differs from that of the table.

Their sizes are assumed, like the values they act on: they tell what a table lives on, not what will happen.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

from plant_models import Plant
from synth.retarder.configuration.plant_parameter import nominal_value
from synth.retarder.configuration.plant_values import SLOPES, with_values

Change = Callable[[Plant], Plant]


@dataclass(frozen=True)
class Condition:
    """`key` in `summary.json`; `name` in sentences and tables; `changes` by what they do: the worst of them counts."""

    key: str
    name: str
    changes: Mapping[str, Change]


def times(factor: float, *keys: str) -> Change:
    """The values under `keys` of the configuration times `factor`; of those that the plant has."""

    def changed(plant: Plant) -> Plant:
        known = {key: nominal_value(plant, key) for key in keys}
        return with_values(plant, {key: factor * value for key, value in known.items() if value is not None})

    return changed


def losing(share: float, burst_s: float) -> Change:
    """The radar loses `share` of its readings, in bursts of `burst_s` on average, of at least one reading."""

    def changed(plant: Plant) -> Plant:
        burst = max(burst_s, plant.sensor.sample_period_s)
        return with_values(plant, {"sensor.missed_share": share, "sensor.missed_burst_s": burst})

    return changed


VALVES: Final = tuple(
    f"retarder.pneumatics.{name}"
    for name in (
        "brake_delay_s", "touch_delay_s", "release_delay_s", "closing_delay_s", "fill_time_constant_s",
        "exhaust_time_constant_s",
    )
)  # fmt: skip

CONDITIONS: Final = (
    # ξ and the slope K enter the force as their product: all friction times 0.7, its floor too, is another K.
    Condition("low_friction", "friction × 0.7", {"friction × 0.7": times(0.7, *SLOPES)}),
    Condition("slow_valves", "valves slower × 1.5", {"valve delays and time constants × 1.5": times(1.5, *VALVES)}),
    Condition(
        "lost_readings",
        "a third of the readings lost",
        {"a third of the readings lost, in bursts of 0.6 s on average": losing(1.0 / 3.0, 0.6)},
    ),
    Condition(
        "wrong_weight",
        "weight ± 10 %",
        {"the cut 10 % lighter": times(0.9, "cut.mass_t"), "the cut 10 % heavier": times(1.1, "cut.mass_t")},
    ),
)
"""In the order of the report."""
