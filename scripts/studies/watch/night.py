"""A night of the positions of a hump, each fault of the library at one of them: what `hump watch` makes of the logs."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from scripts.studies.watch.findings import Ranked
from scripts.studies.watch.pools import Change
from synth.cli import main
from synth.hump.hump_file import read_graph
from synth.simulation.logged_passes import GAP_S
from tuning_tables.pass_log.join_logs import join_logs, one_after_the_other
from tuning_tables.pass_log.log_files import write_log
from tuning_tables.pass_log.pass_log import PassLog

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
    return [each.number for each in read_graph(Path(HUMP)).graph.retarders]


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
