"""What is shown of shares of variance: what to measure first, then every share with its interval, then the ranges."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any, Final

from synth.frame.exhibits import Chart, Column, Exhibit, Row, Sentence, Table
from synth.frame.interval import Interval
from synth.retarder.sensitivity.responses import NEVER_VARIED
from synth.retarder.sensitivity.sensitivity import (
    REPEATED,
    UNDECIDABLE,
    OutputShares,
    Sensitivity,
    measure_first,
    percent,
)
from synth.retarder.sensitivity.shares import GROUPS, HARMONICS, Share

METHOD: Final = (
    "first-order shares by random balance designs (RBD-FAST, bias corrected) on a Latin hypercube; 95 % "
    "intervals by a jackknife of groups"
)
TOGETHER, NOISE = "parameters together", "noise of the passes"


def hundredths(value: float) -> str:
    """A share in whole per cent."""
    return f"{100.0 * value:.0f}"


def undecided(value: Any) -> bool:
    """The interval of a share holds 0."""
    return isinstance(value, Interval) and value.low95 <= 0.0


CASE = (Column("case", "case", words=True, once=True), Column("target_m_s", "target", "m/s", once=True))
OUTPUT = (
    *CASE,
    Column("output", "of the exits", words=True),
    Column("unit", "unit", words=True),
    Column("nominal", "where nothing varies"),
    Column("mean", "mean over the points"),
    Column("std", "standard deviation"),
)
RANGES = (
    Column("class", "class", words=True, once=True),
    Column("key", "key", words=True),
    Column("name", "parameter", words=True),
    Column("nominal", "value"),
    Column("low", "from"),
    Column("high", "to"),
    Column("assumed", "assumed"),
)
HELD = (Column("key", "key", words=True), Column("why", "why", words=True))


def first(found: Sensitivity) -> Iterator[Exhibit]:
    """What to measure first, by output."""
    trial = found.trial
    yield Sentence(
        f"Mean over {len(found.cases)} tables, each on {trial.points} plants with {trial.passes} passes:",
        {**asdict(trial), "repeated_points": REPEATED},
        brief=True,
    )
    for each in found.overall:
        figures = {f"first_{each.output.name}": leader(found, each)}
        yield Sentence(measure_first(found.names, each), figures, brief=True, to_do=True)
        if each.varies:
            open_ones = sum(not share.decided for share in each.shares)
            yield Sentence(
                f"  parameters together {percent(each.together)}, noise of the passes {100.0 * each.noise.value:.1f} %"
                f"; {open_ones} of {len(found.keys)} parameters {UNDECIDABLE}",
                brief=True,
            )


def leader(found: Sensitivity, each: OutputShares) -> str | None:
    """The key of the largest share that is decided."""
    decided = [(share.value, key) for key, share in zip(found.keys, each.shares, strict=True) if share.decided]
    return max(decided)[1] if each.varies and decided else None


def shares(found: Sensitivity) -> Iterator[Exhibit]:
    """Means over all cases."""
    trial = found.trial
    yield Sentence(
        f"{trial.points} plants, {trial.passes} passes of every table on each, seed {trial.seed}: {METHOD}. In "
        f"per cent, 95 % intervals in brackets; grey: {UNDECIDABLE}.",
        {"method": METHOD, "harmonics": HARMONICS, "groups": GROUPS},
    )
    columns = share_columns(found)
    yield Table("overall", "Means over all cases, %", columns, share_rows(found, found.overall, {}))
    yield Chart(
        "sensitivity-overall",
        "Shares of variance, all cases",
        "Share of the variance that each number alone accounts for, mean over the cases, with 95 % intervals. Grey: "
        "the interval holds 0, so these passes do not decide.",
        lambda: _pictures().share_bars(found),
    )
    yield Chart(
        "sensitivity-cases",
        "Shares of variance by case",
        "Per cent of the variance of the rms exit error, by class of cuts and target. Grey figures are not decided.",
        lambda: _pictures().share_cells(found),
    )


def case_by_case(found: Sensitivity) -> Iterator[Exhibit]:
    """The shares of every table, and the figures of its exits."""
    rows = [
        row
        for case in found.cases
        for row in share_rows(found, case.outputs, {"case": case.label, "target_m_s": case.target_m_s})
    ]
    yield Table("cases", "Shares of variance of every table, %", (*CASE, *share_columns(found)), rows)
    exits = [
        {"case": case.label, "target_m_s": case.target_m_s, "nominal": nominal, **figures_of(each)}
        for case in found.cases
        for nominal, each in zip(case.nominal, case.outputs, strict=True)
    ]
    means = [{"case": "all", **figures_of(each)} for each in found.overall]
    yield Table("exits", "The exits over the points", OUTPUT, [*means, *exits])


def share_columns(found: Sensitivity) -> tuple[Column, ...]:
    """A parameter, and its share of the variance of each output."""
    outputs = (Column(each.output.name, each.output.title, form=hundredths, grey=undecided) for each in found.overall)
    return Column("key", "key", words=True), Column("name", "parameter", words=True), *outputs


def share_rows(found: Sensitivity, outputs: Sequence[OutputShares], head: Row) -> list[Row]:
    """A row a parameter, the largest share of the first output on top; then what is left."""
    n = found.trial.points
    order = sorted(range(len(found.keys)), key=lambda place: -outputs[0].shares[place].value)
    rows: list[Row] = [
        {**head, "key": found.keys[place], "name": found.names[place],
         **{each.output.name: interval(each.shares[place], n) for each in outputs if each.varies}}
        for place in order
    ]  # fmt: skip
    for key, part in (("together", TOGETHER), ("noise", NOISE)):
        told = {each.output.name: interval(getattr(each, key), n) for each in outputs if each.varies}
        rows.append({**head, "key": key, "name": part, **told})
    return rows


def interval(share: Share, n: int) -> Interval:
    """The share with its interval over so many points."""
    return Interval(share.value, *share.ci95, n)


def figures_of(each: OutputShares) -> Row:
    """The output itself over the points."""
    return {"output": each.output.title, "unit": each.output.unit, "mean": each.mean, "std": each.std}


def ranges(found: Sensitivity) -> Iterator[Exhibit]:
    """What varies, in the units of the configuration (factors where the number is a list), and what is held."""
    rows = [
        {"class": label, **asdict(one)} for label, varied in found.varied for one in varied if one.key in found.keys
    ]
    yield Table("ranges", "Ranges; of a list: factors", RANGES, rows)
    held = {**dict.fromkeys(found.held, "set by the configuration"), **NEVER_VARIED}
    yield Table("held", "Held", HELD, [{"key": key, "why": why} for key, why in held.items()])


def _pictures() -> Any:
    from synth.retarder.sensitivity import pictures  # matplotlib

    return pictures
