"""What is shown of tables that were simulated once more: a row for each, beside what its file states."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from statistics import median
from typing import Final

from synth.frame.command import Limit
from synth.frame.exhibits import Column, Exhibit, Row, Sentence, Table, Tile, Tiles
from synth.frame.printed_numbers import counted, decimals, per_cent
from synth.retarder.exit_figures import (
    DETAILS,
    EFFORT,
    LEGEND,
    TOLD,
    table_row,
    told,
)
from synth.retarder.validation.revalidation import Revalidation

TABLES: Final = (
    Column("id", "table", words=True),
    *TOLD,
    Column("stated_rms_m_s", "the file states", "m/s", decimals(4), spare=2),
    *EFFORT,
    Column("verdict", "verdict", words=True),
    *DETAILS,
    Column("overspeed_beyond_margin", "beyond the margin of [acceptance]", form=per_cent, detail=True),
    Column("label", "case", words=True, detail=True),
    Column("target_speed_m_s", "target", "m/s", detail=True),
    Column("confirmed", "as the file states", detail=True),
    Column("same_config", "of this configuration", detail=True),
)
WORDS: Final = {"accepted": "limits kept", "missed": "limits missed", "not decidable": "not decidable"}


def tables(title: str, seed: int, found: Sequence[Revalidation]) -> Iterator[Exhibit]:
    """A row for each table, and what it comes to."""
    yield first_tiles(found)
    yield from (Sentence(step, to_do=True) for step in to_do(found))
    yield Table("tables", title, TABLES, [row_of(each) for each in found], True)
    passes = found[0].statistics.passes
    yield Sentence(f"{passes} stratified passes of each table, seed {seed}. {LEGEND}", {"seed": seed}, brief=True)
    for each in found:
        if each.confirmed is False:
            sentence = f"{each.table.id}: these passes do not confirm the interval that the file states."
            yield Sentence(sentence, brief=True)
        if each.infeasible and each.judgement.phrases:
            yield Sentence(
                f"{each.table.id}: {', '.join(each.judgement.phrases)}; summary.json beside the tables calls this case "
                "infeasible, so it does not count.",
                brief=True,
            )


def first_tiles(found: Sequence[Revalidation]) -> Tiles:
    """How many tables keep the limits, how near cuts leave, and how many files these passes confirm."""
    counting = [each for each in found if not each.infeasible]
    kept = sum(each.judgement.word == "accepted" for each in counting)
    missed = any(each.judgement.missed for each in counting)
    whole = Tile(
        f"{kept} of {len(counting)}", "tables keep the limits of [acceptance]; infeasible cases do not count",
        False if missed else True if counting and kept == len(counting) else None,
    )  # fmt: skip
    near = [each.statistics.p95_m_s for each in counting] or [each.statistics.p95_m_s for each in found]
    half = Tile(
        f"±{median(near):.3f} m/s",
        f"of the commanded speed leave 95 of 100 cuts: median, from ±{min(near):.3f} to ±{max(near):.3f}",
    )
    stated = [each.confirmed for each in found if each.confirmed is not None]
    same = Tile(f"{sum(stated)} of {len(stated)}", "files state an rms that these passes confirm")
    return Tiles((whole, half, *((same,) if stated else ())))


def to_do(found: Sequence[Revalidation]) -> Iterator[str]:
    """What the passes call for."""
    other = [each for each in found if not each.same_config]
    if other:
        yield (
            f"Give the configuration that made the tables: {len(other)} of {counted(len(found), 'table')} were made "
            "from another one."
        )
    if any(each.confirmed is False for each in found):
        yield "Find out why a file states another rms than these passes have, before you load its table."
    if any(each.judgement.missed for each in found if not each.infeasible):
        yield "Do not load a table that misses a limit; tune again, or change the limits of [acceptance]."
    if any(each.judgement.word == "not decidable" for each in found if not each.infeasible):
        yield "Ask for more passes (--passes): with these some limits are not decidable."


def limits_of(found: Sequence[Revalidation]) -> Iterator[Limit]:
    """A limit for each table that does not keep all, or one for all of them."""
    counting = [each for each in found if not each.infeasible]
    short = [each for each in counting if each.judgement.word != "accepted"]
    for each in short:
        sentence = f"{each.table.id}: {', '.join(each.judgement.phrases)}"
        yield Limit(sentence, False if each.judgement.missed else None)
    if counting and not short:
        yield Limit(f"the limits are kept by {counted(len(counting), 'table')}", True)


def row_of(found: Revalidation) -> Row:
    """One table."""
    stated, n = found.table.validated, found.statistics.passes
    return {
        "id": found.table.id,
        "label": found.label,
        "target_speed_m_s": found.table.target_speed_m_s,
        **table_row(found.statistics, found.brake_power, found.table.predicted),
        "stated_rms_m_s": stated and told(stated.rms_m_s, stated.rms_ci95_m_s, stated.passes),
        "overspeed_beyond_margin": told(*found.overspeed, n),
        "confirmed": found.confirmed,
        "same_config": found.same_config,
        "verdict": verdict(found),
    }


def verdict(found: Revalidation) -> str:
    """What a table's passes come to, in a few words."""
    if found.infeasible:
        return "infeasible"
    confirmed = {True: ", as stated", False: ", not as stated", None: ""}[found.confirmed]
    return WORDS[found.judgement.word] + confirmed
