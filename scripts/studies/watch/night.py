"""Simulated passes of a position in order and of a changed one with what they say for each drift, and a night of
the positions of a hump, each fault of the library at one of them: what `hump watch` makes of the logs.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from plant_models import Plant
from plant_models.pressure_regulator import PressureGauge
from scripts.studies.changed_plants import friction, times
from scripts.studies.watch.findings import Ranked
from synth.cli import main
from synth.hump.hump_file import read_graph
from synth.logs import unknowns as asked
from synth.logs.drift.causes import Cause
from synth.logs.drift.evidence import Evidence, evidence_of
from synth.logs.fitting_passes import fitting_passes
from synth.simulation.controllers import TableController
from synth.simulation.sampled_pass import GAP_S, LoggedClass, mixed_log
from tuning_tables import ControllerTable
from tuning_tables.active_table import active
from tuning_tables.pass_log.log_files import write_log
from tuning_tables.pass_log.pass_log import PassLog, join_logs, one_after_the_other

GAUGE = PressureGauge(2.0, 1.0)


@dataclass(frozen=True)
class Change:
    """What happens to the position: `cause` is what the watch is to name; `changed` plant; what sensor and gauge
    show too much; `is_of_drive`: it is sought only with a gauge on the drive."""

    title: str
    cause: str
    changed: Callable[[Plant], Plant]
    bias_m_s: float = 0.0
    gauge_off_kpa: float = 0.0
    is_of_drive: bool = False


LIGHT = "Л"
"""A weight category of the built-in configuration."""


def of_light(changed: Callable[[Plant], Plant]) -> Callable[[Plant], Plant]:
    """The change for cuts of one category alone."""
    return lambda plant: changed(plant) if plant.cut.category == LIGHT else plant


IN_ORDER = Change("none", "", lambda plant: plant)

CHANGES = (
    Change("friction −30 %", "friction", friction(0.7, 1.0)),
    Change("friction −10 %", "friction", friction(0.9, 1.0)),
    Change("exhaust constant +50 %", "exhaust constant", times(asked.EXHAUST, 1.5)),
    Change("sensor bias +0.1 m/s", "sensor bias", lambda plant: plant, 0.1),
    Change("friction of category Л −30 %", f"friction of {LIGHT}", of_light(friction(0.7, 1.0))),
    Change("spread of friction ×2", "friction spread", friction(1.0, 2.0)),
    Change("rolling resistance +50 %", "rolling resistance", times("cut.rolling_resistance.mean_n_per_kn", 1.5)),
    Change("fill constant +50 %", "fill constant", times(asked.FILL, 1.5), is_of_drive=True),
    Change("brake delay ×2", "brake delay", times(asked.BRAKE_DELAY, 2.0), is_of_drive=True),
    Change("release delay ×2", "release delay", times(asked.RELEASE_DELAY, 2.0), is_of_drive=True),
    Change("dead band +50 %", "dead band", times(asked.DEAD_BAND, 1.5), is_of_drive=True),
    Change("touch pressure +30 %", "touch pressure", times(asked.TOUCH_PRESSURE, 1.3), is_of_drive=True),
    Change("sensor noise ×2", "sensor noise", times(asked.NOISE, 2.0)),
    Change("gauge offset +10 kPa", "gauge offset", lambda plant: plant, gauge_off_kpa=10.0, is_of_drive=True),
)
"""One at least of each cause that the watch knows; sizes are assumed."""


def simulated(
    tables: Sequence[tuple[Plant, ControllerTable]], change: Change, passes: int, seed: int, gauge: PressureGauge | None
) -> PassLog:
    """`passes` of the tables' classes in equal parts, in random order.

    A sensor that shows b too much compares v + b with the lines: the same as v with lines that lie lower by b, and b
    added to what is logged.
    """
    classes = []
    for plant, table in tables:
        coefficients = table.coefficients.copy()
        coefficients[:, :, 0] -= np.float32(change.bias_m_s)
        shifted = replace(active(table), coefficients=coefficients)
        classes.append(LoggedClass(change.changed(plant), TableController(shifted), table.target_speed_m_s))
    log = mixed_log(classes, [max(1, passes // len(classes))] * len(classes), seed, gauge)
    return replace(log, speed_m_s=log.speed_m_s + change.bias_m_s, pressure_kpa=log.pressure_kpa + change.gauge_off_kpa)


@dataclass(frozen=True, eq=False)
class Judge:
    """What logs are held against."""

    plants: tuple[tuple[str, Plant], ...]
    values: dict[str, float]
    causes: tuple[Cause, ...]
    slope_key: str

    def evidence(self, log: PassLog) -> Evidence:
        """What `log` says for each cause."""
        passes = fitting_passes(log, self.plants, "the study")
        return evidence_of(passes, self.values, self.causes, self.slope_key, 2)


def joined(before: Evidence, after: Evidence) -> Evidence:
    """One after the other."""
    ratios = tuple(np.concatenate(pair) for pair in zip(before.ratios, after.ratios, strict=True))
    return Evidence(before.causes, ratios, np.concatenate((before.exit_m_s, after.exit_m_s)))


HUMP = "medium"


def night(
    calm: PassLog, faults: list[tuple[Change, PassLog]], passes: int, trains: int, seed: int
) -> tuple[int, tuple[Ranked, ...]]:
    """(positions, the list of repairs) of a night of `passes` of each position; each fault comes to one of them after
    half of these. Passes are drawn from `calm` and from those with the fault, none twice at one position."""
    rng = np.random.default_rng([seed, 2])
    retarders = sorted(retarder_numbers())
    faulty = dict(zip(spread(retarders, len(faults)), faults, strict=True))
    with TemporaryDirectory() as folder:
        root = Path(folder)
        for retarder in retarders:
            change = faulty.get(retarder)
            parts = [some(calm, passes if change is None else passes // 2, rng)]
            if change is not None:
                parts.append(some(change[1], passes - passes // 2, rng))
            log = one_after_the_other(join_logs(parts), GAP_S)
            (root / "logs").mkdir(exist_ok=True)
            write_log(
                replace(log, cut_id=tuple(f"cut-{number}" for number in range(len(log)))),
                root / "logs" / f"{retarder}.csv",
            )
        (root / "trial.toml").write_text(f'hump = "{HUMP}"\n', encoding="utf-8")
        (root / "yard.toml").write_text(yard_toml(retarders, passes, trains), encoding="utf-8")
        main(["hump", "watch", str(root / "yard.toml"), "-o", str(root / "out"), "-q"])
        told = json.loads((root / "out" / "summary.json").read_text(encoding="utf-8"))
    return len(retarders), tuple(ranked(told, {str(key): change for key, (change, _) in faulty.items()}))


def retarder_numbers() -> list[int]:
    """Those of the hump."""
    return [each.number for each in read_graph(Path(HUMP)).entry.graph.retarders]


def spread(retarders: list[int], count: int) -> list[int]:
    """Some of them, from the crest to the tracks."""
    return [retarders[place] for place in np.linspace(0, len(retarders) - 1, count).round().astype(int).tolist()]


def some(log: PassLog, count: int, rng: np.random.Generator) -> PassLog:
    """So many passes in another order."""
    return log.taken(rng.permutation(len(log))[:count])


def yard_toml(retarders: list[int], passes: int, trains: int) -> str:
    """The file of the yard."""
    head = f'trial = "trial.toml"\nlogs = "logs/{{name}}.csv"\n[false_alarms]\npasses = {passes}\n'
    return (
        head
        + f"[cost]\nnumber = {trains}\n[output]\nplots = false\n"
        + "".join(f'[[position]]\nname = "{number}"\nretarder = {number}\n' for number in retarders)
    )


def ranked(told: dict[str, Any], faulty: dict[str, Change]) -> list[Ranked]:
    """The list of repairs, then the faults that are not on it."""
    tables = {name: {row["position"]: row for row in rows} for name, rows in told["tables"].items()
             if name in ("repairs", "evidence")}  # fmt: skip
    found = [
        Ranked(
            row["rank"], position, faulty[position].title if position in faulty else "none",
            row["drift"], position in faulty and row["cause"] == faulty[position].cause,
            tables["evidence"][position]["passes_to_alarm"],
            interval(row["overspeeds_per_hour"]), interval(row["cars_lost_per_hour"]), interval(row["weight_per_hour"]),
            row["is_ahead"],
        )
        for position, row in tables.get("repairs", {}).items()
    ]  # fmt: skip
    return found + [
        Ranked(0, position, change.title, "not found", False, 0, None, None, None, None)
        for position, change in faulty.items()
        if position not in tables.get("repairs", {})
    ]


def interval(told: Any) -> tuple[float, float, float] | None:
    """Value, low and high."""
    return None if told is None else (told["value"], told["low95"], told["high95"])
