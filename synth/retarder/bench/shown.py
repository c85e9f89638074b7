"""What is shown of a run on the bench: the score, how the controller answered, what was refused, every cut."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

from synth.frame.command import Limit
from synth.frame.exhibits import Chapter, Chart, Column, Exhibit, File, Row, Sentence, Table, Tile, Tiles
from synth.frame.printed_numbers import counted, decimals
from synth.retarder.bench.exchange import TOLERANCE
from synth.retarder.bench.score import GROUPS, FoundBench, Score, score_of
from synth.retarder.bench.wires import c_header
from synth.retarder.comparison.measured import interval_text
from synth.retarder.exit_figures import CASE, PREDICTED, SWITCHINGS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEADER: Final = "bench_wires.h"

SCORES: Final = (
    *CASE,
    Column("cuts", "cuts"),
    Column("rms_m_s", "rms, these cuts", "m/s", decimals(4)),
    Column("range_m_s", "95 of 100 such groups under the table", "m/s", decimals(4)),
    PREDICTED,
    Column("by_table_m_s", "the table, these cuts", "m/s", decimals(4)),
    Column("ratio", "controller / table", form=decimals(3)),
    Column("relay_m_s", "relay, these cuts", "m/s", decimals(4), spare=2),
    Column("energy_rule_m_s", "energy rule, these cuts", "m/s", decimals(4), spare=3),
    SWITCHINGS,
    Column("switchings_by_table", "the table's", form=decimals(1), spare=9),
)
CUTS: Final = (
    Column("count", "cut"),
    *(Column(each.key, each.heading, each.unit, words=each.words) for each in CASE),
    Column("number", "of the row of its table"),
    Column("exit_speed_m_s", "exit speed", "m/s", decimals(4)),
    Column("by_table_m_s", "by the table", "m/s", decimals(4)),
    Column("time_s", "time", "s", decimals(2)),
    Column("stalled", "stands"),
    Column("switchings", "commands"),
    Column("samples", "samples"),
    Column("unanswered", "unanswered"),
    Column("moved_alone", "changed, the table would not"),
    Column("held_alone", "held, the table would not"),
    Column("response_s", "longest response", "s", decimals(4)),
    Column("silence", "longest silence, samples"),
)


def scores_of(found: FoundBench) -> list[Score]:
    """That of each table; before them, where there are several, that of all cuts."""
    each = [score_of(one.case.label, one.case.table.target_speed_m_s, [one]) for one in found.errors]
    return each if len(each) == 1 else [score_of("all cuts", None, found.errors), *each]


def limits_of(found: FoundBench) -> Iterator[Limit]:
    """See `command.limits`."""
    score, allowed = scores_of(found)[0], 1.0 / found.prediction_ratio_low
    cuts = counted(score.cuts, "cut")
    yield Limit(
        f"rms {score.rms_m_s:.4f} m/s in {cuts}; of 100 such groups 95 have {interval_text(score.range_m_s)} m/s under "
        "the tables",
        score.rms_m_s <= score.range_m_s[1],
    )
    yield Limit(
        f"on the same {cuts} {score.ratio:.3f} times the rms of the tables, allowed {allowed:.3g}",
        score.ratio <= allowed,
    )
    if score.cuts < found.asked:
        yield Limit(f"{score.cuts} of {found.asked} cuts came, then the controller was silent for good", None)
    if found.cycles:
        count, off = len(found.cycles.took_s), found.cycles.off
        kept = f"the cycle of the bench was kept within {TOLERANCE:.0%} in {count - off} of {count} samples"
        yield Limit(kept, found.cycles.are_kept or None)


def chapters(found: FoundBench) -> Iterator[Chapter]:
    """The score, then the controller, then the cuts."""
    scores = scores_of(found)
    yield Chapter("Score", tuple(score_exhibits(found, scores)))
    yield Chapter("Controller", tuple(controller(found)))
    chart = Chart("cuts", "Exit errors, cut by cut", "Of the controller, and of the table on the same cut.",
                  partial(drawn, found))  # fmt: skip
    rows = [row_of(found, count) for count in range(len(found.passes))]
    header = File(HEADER, c_header().encode("ascii"), "Registers for a client in C")
    yield Chapter("Cuts", (chart, Table("cuts", "Every cut", CUTS, rows, long=True), header))


def score_exhibits(found: FoundBench, scores: Sequence[Score]) -> Iterator[Exhibit]:
    """A row for each table, and what the columns mean."""
    whole, unanswered = scores[0], sum(each.unanswered for each in found.passes)
    samples = sum(each.samples for each in found.passes)
    yield Tiles(
        (
            Tile(
                f"{whole.rms_m_s:.4f} m/s",
                f"rms of the exit error in {counted(whole.cuts, 'cut')}; under the table 95 of 100 such groups have "
                f"{whole.range_m_s[0]:.4f} to {whole.range_m_s[1]:.4f} m/s",
                whole.rms_m_s <= whole.range_m_s[1],
            ),
            Tile(
                f"{whole.ratio:.3f}",
                "times the rms of the table on the same cuts",
                whole.ratio <= 1.0 / found.prediction_ratio_low,
            ),
            Tile(f"{unanswered} of {samples}", "samples were not answered in time", unanswered == 0 or None),
        )
    )
    yield from (Sentence(each, to_do=True) for each in to_do(found, unanswered))
    yield Table("scores", found.title, SCORES, [score_row(each) for each in scores], True)
    yield Sentence(
        f"Cuts as they come, seed {found.seed}; what is told of these cuts is exact, but tells of no others. Under the "
        f"table: of {GROUPS} groups of so many other cuts, simulated. Predicted: of all cuts, rare ones too. Rules: "
        "tuned on other cuts.",
        {"seed": found.seed},
        brief=True,
    )


def to_do(found: FoundBench, unanswered: int) -> Iterator[str]:
    """What the run calls for."""
    if unanswered:
        yield "Find out why samples stayed without an answer: the stage before stood, and the score has it in it."
    if found.traffic.impossible:
        yield "Mend the controller: it commanded a stage that the position does not have."
    if found.cycles and not found.cycles.are_kept:
        yield "Run the bench on a machine with less to do: its own cycle was not kept."


def score_row(score: Score) -> Row:
    """One table, or all."""
    rules = {f"{name.replace(' ', '_')}_m_s": rms for name, rms in score.by_rules_m_s.items()}
    return {**vars(score), "ratio": score.ratio, **rules}


def controller(found: FoundBench) -> Iterator[Sentence]:
    """How it answered, whether it did as its table, what was refused; and the bench's own clock."""

    def total(figure: Callable[..., int]) -> int:
        return sum(map(figure, found.passes))

    samples, traffic = total(lambda each: each.samples), found.traffic
    unanswered, response_s = total(lambda each: each.unanswered), max(each.response_s for each in found.passes)
    silent_s = found.period_s * max(each.silence for each in found.passes)
    yield Sentence(
        f"{unanswered} of {samples} samples with a cut were not answered before the next one; the stage before stood. "
        f"Longest response {1e3 * response_s:.1f} ms, longest silence {silent_s:.1f} s. A command counts from "
        f"{1e3 * found.computing_delay_s:g} ms after its sample, as in the simulator, if it came before the next one.",
        {"samples": samples, "unanswered": unanswered, "response_s": response_s, "silent_s": silent_s},
        brief=True,
    )
    moved, held = total(lambda each: each.moved_alone), total(lambda each: each.held_alone)
    yield Sentence(
        f"In {moved} samples the stage was changed where the table would have held it, in {held} it was held where the "
        "table would have changed it.",
        {"moved_alone": moved, "held_alone": held},
        brief=True,
    )
    last = f" The last refusal: {traffic.last_refusal}." if traffic.refused else ""
    yield Sentence(
        f"Modbus: {counted(traffic.connections, 'connection')}. {counted(traffic.requests, 'request')} (of OPC UA only "
        f"those that write); {traffic.refused} refused, of these {traffic.impossible} of a stage that the position "
        f"does not have.{last}",
        vars(traffic),
        brief=True,
    )
    if found.cycles:
        count, off, worst_s = len(found.cycles.took_s), found.cycles.off, found.cycles.worst_s
        yield Sentence(
            f"{count} cycles of {1e3 * found.period_s:g} ms; {off} differed by more than {TOLERANCE:.0%}, the worst "
            f"took {1e3 * worst_s:.1f} ms. The bench ran {'before' if found.cycles.is_first else 'among'} all else "
            "that the machine had to do.",
            {"cycles": count, "cycles_off": off, "worst_cycle_s": worst_s},
            brief=True,
        )


def row_of(found: FoundBench, count: int) -> Row:
    """One cut."""
    one = found.passes[count]
    case = next(each.case for each in found.errors if each.passes[0].case == one.case)
    target_m_s = case.table.target_speed_m_s
    here = {
        "count": count + 1,
        "label": case.label,
        "target_speed_m_s": target_m_s,
        "by_table_m_s": float(case.by_table.exit_speed_m_s[one.number]),
        **vars(one.end),
    }
    return {column.key: here[column.key] if column.key in here else getattr(one, column.key) for column in CUTS}


def drawn(found: FoundBench) -> Figure:
    """Drawn by a module that needs matplotlib."""
    from synth.retarder.pictures.exits import bench_cuts

    rows = [row_of(found, count) for count in range(len(found.passes))]
    errors, by_table = (
        [row[key] - row["target_speed_m_s"] for row in rows] for key in ("exit_speed_m_s", "by_table_m_s")
    )
    return bench_cuts(errors, by_table)
