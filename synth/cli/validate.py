"""`retarder-synth validate`: exported tables in the closed loop, beside what their file says of them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from synth.cli import LIMITS_MISSED, OK, say
from synth.cli.processors import available

if TYPE_CHECKING:
    from synth.output.validate_table import Revalidation


def validate_command(path: Path, config_path: Path | None, passes: int | None, seed: int | None, as_json: bool) -> int:
    """Simulate the tables in `path`; 1 if one that is not known to be infeasible misses a limit."""
    from synth.cli.interrupt import interruptible
    from synth.configuration.config_file import BUILT_IN, load_config
    from synth.kernel_cache import guarded, use_kernel_cache
    from synth.tables.table_file import is_infeasible, read_tables, summary_beside

    config, (file,) = load_config(config_path), read_tables(path)
    source, summary = str(config_path or BUILT_IN), summary_beside(path)
    use_kernel_cache()
    from synth.output.validate_table import plant_for, revalidate

    for table in file.tables:
        plant_for(table, config, source)  # refused before anything is simulated
    passes = passes or config.validation.passes
    seed = config.validation.seed if seed is None else seed
    threads = available()
    with interruptible():
        found = [
            guarded(revalidate, table, config, source, passes, seed, threads, is_infeasible(table, summary))
            for table in file.tables
        ]
    if not all(each.same_config for each in found):
        say(f"warning: {path} was made from another configuration than {source}; the plant may differ")
    if as_json:
        from synth.output.summary import plain

        print(json.dumps(plain([document(each) for each in found]), indent=1, ensure_ascii=False))
    else:
        print_found(found, seed)
    return LIMITS_MISSED if any(each.missed and not each.infeasible for each in found) else OK


def document(each: Revalidation) -> dict[str, Any]:
    """One table's result for programs."""
    from dataclasses import asdict

    stated = each.table.validated
    return {
        "id": each.table.id,
        "label": each.label,
        "target_speed_m_s": each.table.target_speed_m_s,
        "simulated": asdict(each.statistics),
        "overspeed_beyond_margin": each.overspeed,
        "stated": {
            "predicted_rms_m_s": each.table.predicted.rms_m_s,
            "validated": asdict(stated) if stated else None,
        },
        "honesty": each.honesty,
        "confirmed": each.confirmed,
        "missed_limits": each.missed,
        "known_infeasible": each.infeasible,
        "same_config": each.same_config,
    }


def print_found(found: list[Revalidation], seed: int) -> None:
    """A table with one row for each table, and what it comes to."""
    from rich import box
    from rich.table import Table

    from synth.cli.book_table import ratio, share, speed, stdout_console

    shown = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for name in ("table", "rms [95 %], m/s", "bias, m/s", "p99, m/s", "over-speed", "stalls", "switchings",
                 "the file states", "predicted", "honesty", "verdict"):  # fmt: skip
        shown.add_column(name, justify="left" if name in ("table", "verdict") else "right")
    for each in found:
        s, stated = each.statistics, each.table.validated
        claim = f"[{speed(stated.rms_ci95_m_s[0])}, {speed(stated.rms_ci95_m_s[1])}]" if stated else "–"
        shown.add_row(
            each.table.id,
            f"{speed(s.rms_m_s)} [{speed(s.rms_ci95_m_s[0])}, {speed(s.rms_ci95_m_s[1])}]",
            f"{s.bias_m_s:+.3f}",
            speed(s.p99_m_s),
            share(each.overspeed),
            share(s.stalls / s.passes),
            f"{s.switchings:.1f}",
            claim,
            speed(each.table.predicted.rms_m_s),
            ratio(each.honesty),
            verdict(each),
        )
    console = stdout_console()
    console.print(shown, markup=False)
    console.print(f"{found[0].statistics.passes} passes of each table, seed {seed}")
    for each in found:
        if each.confirmed is False:
            console.print(f"{each.table.id}: these passes do not confirm the interval that the file states")
        if each.missed:
            outside = "; summary.json calls this case infeasible, so it does not count" if each.infeasible else ""
            console.print(f"{each.table.id}: {', '.join(each.missed)}{outside}", soft_wrap=True)


def verdict(each: Revalidation) -> str:
    """What a table's passes come to, in a few words."""
    if each.infeasible:
        return "infeasible"
    confirmed = {True: ", as stated", False: ", not as stated", None: ""}[each.confirmed]
    return ("limits missed" if each.missed else "limits kept") + confirmed
