"""`retarder-synth validate`: exported tables in the closed loop, beside what their file says of them."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from synth.frame.processors import available
from synth.frame.terminal.telling import LIMITS_MISSED, OK, say

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from synth.book.validate_table import Rehearsal, Revalidation
    from tuning_tables import ControllerTable
    from tuning_tables.passages.passage_table import PassageTable


LOG_PASSES = 200
"""Of a log, unless the user says otherwise."""


@dataclass(frozen=True)
class AskedLog:
    """`passes` passes of each table are to be logged in the file at `path`; `gauge_std_kpa` NaN: without a gauge."""

    path: Path
    passes: int
    gauge_std_kpa: float


def asked_log(path: Path | None, passes: int | None, gauge_std_kpa: float | None) -> AskedLog | None:
    """What the options ask for; None for no log. `InputError` for options of a log without one, or a wrong ending."""
    from synth.frame.input_error import InputError
    from synth.frame.new_file import require_new
    from tuning_tables.pass_log.log_files import require_writable_name

    if path is None:
        if passes is not None or gauge_std_kpa is not None:
            raise InputError("--log-passes and --gauge-std are about a log; say by --log FILE.csv where it is to go")
        return None
    require_writable_name(path)
    require_new(path)
    from plant_models.pressure_gauge import USUAL_NOISE_KPA

    return AskedLog(path, passes or LOG_PASSES, USUAL_NOISE_KPA if gauge_std_kpa is None else gauge_std_kpa)


def validate_command(
    path: Path, config_path: Path | None, passes: int | None, seed: int | None, log: AskedLog | None, as_json: bool
) -> int:
    """Simulate the tables in `path`; 1 if one that is not known to be infeasible is not shown to keep every limit."""
    from synth.book.forms.table_file import is_infeasible, summary_beside
    from synth.cli.tables_configuration import configuration_for
    from synth.frame.input_error import InputError
    from synth.frame.terminal.interrupt import interruptible
    from synth.kernels.cache import guarded

    passages, tables = tables_in(path)
    config, source = configuration_for(config_path, passages)
    summary = summary_beside(path)
    from synth.book.passage_class import passage_class
    from synth.book.sensors.revalidate_passages import revalidate_passages
    from synth.book.validate_table import Rehearsal, plant_for, revalidate_all

    if passages and log is not None:
        raise InputError(f"{path}: its tables are for point sensors, whose passes are not logged; leave out --log")
    for table in tables:
        plant_for(table, config, source)  # refused before anything is simulated
    for each in passages:
        passage_class(each, config, source)
    passes = passes or config.validation.passes
    seed = config.validation.seed if seed is None else seed
    rehearsal = Rehearsal(config, source, passes, seed, available())
    with interruptible():
        if log is not None:
            guarded(write_rehearsed_log, tables, rehearsal, log)
        if passages:
            known = [is_infeasible(table, summary) for table in passages]
            found = guarded(revalidate_passages, passages, rehearsal, known)
        else:
            known = [is_infeasible(table, summary) for table in tables]
            found = guarded(revalidate_all, tables, rehearsal, known)
    if not all(each.same_config for each in found):
        say(f"warning: {path} was made from another configuration than {source}; the plant may differ")
    if as_json:
        from synth.book.summary import plain

        print(json.dumps(plain([document(each, seed) for each in found]), indent=1, ensure_ascii=False))
    else:
        print_found(found, seed, log)
    return OK if all(each.judgement.word == "accepted" or each.infeasible for each in found) else LIMITS_MISSED


def tables_in(path: Path) -> tuple[tuple[PassageTable, ...], tuple[ControllerTable, ...]]:
    """The tables of the file at `path`: for point sensors, or with lines; the other part is empty."""
    from synth.book.forms.passage_file import read_passages
    from synth.book.forms.table_file import read_tables

    passages = () if path.is_dir() else read_passages(path)
    return passages, () if passages else read_tables(path)[0].tables


def write_rehearsed_log(tables: Sequence[ControllerTable], rehearsal: Rehearsal, asked: AskedLog) -> None:
    """Simulate passes of `tables` once more, as cuts come, and write what a controller logs of them."""
    from plant_models.pressure_gauge import PressureGauge
    from synth.book.rehearsed_log import rehearsed_log
    from synth.frame.new_file import require_new
    from tuning_tables.pass_log.log_files import write_log

    gauge = None if math.isnan(asked.gauge_std_kpa) else PressureGauge(asked.gauge_std_kpa)
    log = rehearsed_log(tables, rehearsal, asked.passes, gauge)
    require_new(asked.path)  # again: it may have come while passes were simulated
    write_log(log, asked.path)


def document(each: Revalidation, seed: int) -> dict[str, Any]:
    """One table's result for programs."""
    from dataclasses import asdict

    stated = each.table.validated
    return {
        "id": each.table.id,
        "label": each.label,
        "target_speed_m_s": each.table.target_speed_m_s,
        "seed": seed,
        "simulated": asdict(each.statistics),
        "brake_power": asdict(each.brake_power),
        "overspeed_beyond_margin": each.overspeed[0],
        "overspeed_beyond_margin_ci95": each.overspeed[1],
        "stated": {
            "predicted_rms_m_s": each.table.predicted.rms_m_s,
            "validated": asdict(stated) if stated else None,
        },
        "honesty": each.honesty[0],
        "honesty_ci95": each.honesty[1],
        "confirmed": each.confirmed,
        "missed_limits": each.judgement.missed,
        "undecided_limits": each.judgement.undecided,
        "sentences": each.judgement.phrases,
        "known_infeasible": each.infeasible,
        "same_config": each.same_config,
    }


def print_found(found: list[Revalidation], seed: int, log: AskedLog | None) -> None:
    """A table with one row for each table, and what it comes to."""
    from synth.cli.book_table import LEGEND
    from synth.cli.case_columns import OUT_OF_BRAKE_IN, PREDICTED, WITHIN
    from synth.frame.printed_numbers import plus_minus, speed, ten_thousand
    from synth.frame.terminal.printed_page import Exhibit, print_page
    from synth.frame.terminal.printed_table import Column, PrintedTable

    def error(figure: str) -> Callable[[Revalidation], str]:
        return lambda each: plus_minus(
            getattr(each.statistics, f"{figure}_m_s"), getattr(each.statistics, f"{figure}_ci95_m_s"), 4
        )

    def stated(each: Revalidation) -> str | None:
        validated = each.table.validated
        return None if validated is None else plus_minus(validated.rms_m_s, validated.rms_ci95_m_s, 4)

    def out_of_brake(each: Revalidation) -> str:
        return ten_thousand(each.brake_power.out_of_brake, each.brake_power.out_of_brake_ci95)

    columns: tuple[Column[Revalidation], ...] = (
        Column("table", lambda each: each.table.id, words=True),
        Column("rms, m/s", error("rms")),
        Column(WITHIN["p95"], error("p95"), spare=4),
        Column(WITHIN["p99"], error("p99"), spare=5),
        Column(OUT_OF_BRAKE_IN, out_of_brake, spare=1),
        Column("switchings", lambda each: f"{each.statistics.switchings:.1f}", spare=6),
        Column("time, s", lambda each: plus_minus(each.statistics.time_s, each.statistics.time_ci95_s), spare=7),
        Column("the file states, m/s", stated, spare=2),
        Column("predicted, m/s", lambda each: speed(each.table.predicted.rms_m_s), spare=3),
        Column(PREDICTED, lambda each: plus_minus(*each.honesty)),
        Column("verdict", verdict, words=True),
    )
    page: list[Exhibit] = [
        PrintedTable(columns, found, "the output of --json"),
        f"{found[0].statistics.passes} stratified passes of each table, seed {seed}",
        LEGEND,
    ]
    for each in found:
        if each.confirmed is False:
            page.append(f"{each.table.id}: these passes do not confirm the interval that the file states")
        if each.judgement.phrases:
            outside = "; summary.json calls this case infeasible, so it does not count" if each.infeasible else ""
            page.append(f"{each.table.id}: {', '.join(each.judgement.phrases)}{outside}")
    if log is not None:
        page.append(f"{log.passes} passes of each table, as a controller logs them: {log.path}")
    print_page(*page)


def verdict(each: Revalidation) -> str:
    """What a table's passes come to, in a few words."""
    if each.infeasible:
        return "infeasible"
    confirmed = {True: ", as stated", False: ", not as stated", None: ""}[each.confirmed]
    word = {"accepted": "limits kept", "missed": "limits missed", "not decidable": "not decidable"}[each.judgement.word]
    return word + confirmed
