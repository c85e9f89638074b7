"""What is shown of a replay: exits under both tables, what they command, measured over predicted, and every pass."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any, Final

from synth.frame.exhibits import Chart, Column, Exhibit, Row, Sentence, Table
from synth.frame.interval import Interval
from synth.frame.printed_numbers import decimals
from synth.logs.replay.predicted_exits import Bootstrapped, PredictedExits
from synth.logs.replay.replay import Replay
from synth.logs.replay.rule_agreement import RuleAgreement

DOUBTFUL_P: Final = 0.01
"""Below this p value the configuration is said not to describe the log."""

OWN, OTHER = "tables of the log", "other tables"

EXITS: Final = (
    Column("figure", "exit less target", words=True),
    Column("own", OWN, form=decimals(4)),
    Column("other", OTHER, form=decimals(4)),
    Column("difference", "difference", form="{:+.4f}".format),
    Column("unit", "unit", words=True),
)
AGREEMENT: Final = (
    Column("tables", "tables", words=True),
    Column("rows_same", "readings commanded as logged"),
    Column("rows_asked", "of readings"),
    Column("commands_same", "commands as logged"),
    Column("commands_all", "of commands"),
    Column("passes_that_differ", "passes that differ somewhere", spare=1),
)
REASONS: Final = (Column("why", "left out because", words=True), Column("passes", "passes"))
LEFT_OUT: Final = (Column("cut_id", "cut", words=True), Column("why", "why", words=True))
PASS: Final = (
    Column("cut_id", "cut", words=True),
    Column("class", "class", words=True),
    Column("target_m_s", "target", "m/s"),
    Column("measured_m_s", "measured exit", "m/s", decimals(4)),
    *(
        Column(f"{key}_{part}_m_s", f"{heading}, {words}", "m/s", decimals(4))
        for key, heading in (("own", OWN), ("other", OTHER))
        for part, words in (("mean", "mean"), ("low80", "80 % band from"), ("high80", "to"))
    ),
    Column("rank", "rank among the predicted"),
    Column("first_differing_row", "first row that differs"),
)


def is_described(found: Replay) -> bool:
    """Nothing speaks against the configuration."""
    return not found.uniformity.p_value < DOUBTFUL_P  # NaN is not


def uniformity_sentence(found: Replay) -> str:
    """What the test says, with its p value and the least one."""
    test = found.uniformity
    return (
        f"{test.n} measured exits {'agree' if is_described(found) else 'do not agree'} with those predicted for the "
        f"tables of the log (Kolmogorov–Smirnov test of their ranks: p = {test.p_value:.2g}, at least {DOUBTFUL_P:g})"
    )


def exits(found: Replay) -> Iterator[Exhibit]:
    """What the other tables would have changed."""
    d = found.difference
    figures = {"compared_passes": d.passes, "effective_passes": d.effective}
    if not d.passes:
        yield Sentence("No pass has a table in both books: nothing is compared.", figures, brief=True)
        return
    yield Table("exits", "Exits of the same cuts", EXITS, list(exit_rows(found)), brief=True)
    yield Sentence(
        f"On {d.passes} cuts; the difference of the rms is carried by {d.effective:.0f} of them.", figures, brief=True
    )
    yield Chart(
        "replay-tables",
        "Exits under both tables",
        "Predicted exit less target of the same cuts under the tables that drove the log and the others: mean "
        "and 80 % band of each pass, sorted by the mean under the tables of the log.",
        lambda: _pictures().own_and_other(found),
    )


def exit_rows(found: Replay) -> Iterator[Row]:
    """Rms and over-speed."""
    d = found.difference
    yield {
        "figure": "rms",
        "own": d.own_rms_m_s,
        "other": d.other_rms_m_s,
        "difference": interval(d.rms_m_s, d.passes),
        "unit": "m/s",
    }
    yield {
        "figure": "share more than 0.3 m/s too fast",
        "own": d.own_overspeed,
        "other": d.other_overspeed,
        "difference": interval(d.overspeed, d.passes),
        "unit": "1",
    }


def interval(figure: Bootstrapped, n: int) -> Interval:
    """The figure of `n` passes."""
    low, high = figure.ci95
    # Passes that are drawn anew need not give what all of them give: with few, the quantiles may lie on one side.
    return Interval(figure.value, min(low, figure.value), max(high, figure.value), n)


def commands(found: Replay, failed: tuple[str, ...]) -> Iterator[Exhibit]:
    """How far both books command what was logged; `failed`: sentences on cases without an own table."""
    rows = [agreement_row(OWN, found.own_agreement), agreement_row(OTHER, found.agreement)]
    yield Table("agreement", "Commands beside the logged ones", AGREEMENT, rows, brief=True)
    for sentence in failed:
        yield Sentence(sentence, brief=True)


def agreement_row(tables: str, agreement: RuleAgreement) -> Row:
    """Counts of readings and of commands."""
    (rows_same, rows_asked), (commands_same, commands_all) = agreement.rows, agreement.commands
    return {
        "tables": tables,
        "rows_same": rows_same,
        "rows_asked": rows_asked,
        "commands_same": commands_same,
        "commands_all": commands_all,
        "passes_that_differ": int((agreement.first_differing >= 0).sum()),
    }


def measured(found: Replay) -> Iterator[Exhibit]:
    """Measured exits among the predicted ones."""
    test = found.uniformity
    figures = {"uniformity": {"n": test.n, "distance": test.distance, "p_value": test.p_value}}
    if not test.n:
        yield Sentence("No exit was measured under a table of the log.", figures, brief=True)
        return
    yield Sentence(
        f"Ranks of {test.n} measured exits among those predicted for any cut of the class that enters as fast: the "
        f"largest distance from level ranks is {test.distance:.3f}.",
        figures,
    )
    yield Chart(
        "replay-measured",
        "Measured over predicted",
        "Left: exit less target, as measured and as predicted for any cut of its class as fast, under the "
        "tables that drove the log. Right: ranks of the measured exits among those; level where log and "
        "configuration agree, dotted: where 95 % of the bars stay then.",
        lambda: _pictures().measured_over_predicted(found),
    )


def passes(found: Replay) -> Iterator[Exhibit]:
    """Every pass, and those that are left out."""
    if found.left_out:
        reasons = Counter(why for _, why in found.left_out).most_common()
        rows = [{"why": why, "passes": count} for why, count in reasons]
        yield Table("reasons", "Passes left out", REASONS, rows, brief=True)
        left_out = [{"cut_id": cut_id, "why": why} for cut_id, why in found.left_out]
        yield Table("left_out", "Which passes are left out", LEFT_OUT, left_out, long=True)
    every = [pass_row(found, number) for number in range(len(found.passes))]
    yield Table("passes", "Every pass", PASS, every, long=True)


def pass_row(found: Replay, number: int) -> Row:
    """One pass; the first row that differs is counted from its first row, 0."""
    log = found.passes.log
    first = int(found.agreement.first_differing[number])
    return {
        "cut_id": log.cut_id[number],
        "class": found.passes.plants[int(found.passes.class_of[number])][0],
        "target_m_s": float(log.target_m_s[number]),
        "measured_m_s": float(found.measured.speed_m_s[number]),
        **predicted("own", found.own, number),
        **predicted("other", found.other, number),
        "rank": float(found.rank[number]),
        "first_differing_row": None if first < 0 else first - int(log.first_row[number]),
    }


def predicted(key: str, exits: PredictedExits, number: int) -> Row:
    """Mean and band of the exit of a pass under one book."""
    low, high = exits.band_m_s[number]
    parts = {"mean": exits.mean_m_s[number], "low80": low, "high80": high}
    return {f"{key}_{part}_m_s": float(value) for part, value in parts.items()}


def _pictures() -> Any:
    from synth.logs.replay import pictures  # matplotlib

    return pictures
