"""What is shown of how fast the computer must be, and of how reliable it is."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from synth.computer.computer_results import ComputerResults
from synth.computer.sized_computer import ControllerRow, SizedComputer, TaskWait
from synth.computer.sizing.counted_needs import Memory, source_channels, total_channels
from synth.frame.exhibits import Chart, Column, Exhibit, Row, Sentence, Table
from synth.frame.interval import Interval
from synth.frame.printed_numbers import amount, per_cent, six_figures, whole

WAITS = (
    Column("task", "task", words=True),
    Column("mean_wait_s", "mean wait", "s"),
    Column("simulated_wait_s", "simulated", "s", spare=1),
    Column("long_share", "share of long waits"),
    Column("long_share_error", "its error", detail=True),
    Column("simulated_long_share", "simulated", spare=1),
    Column("late_share", "share too late", spare=2),
    Column("late_share_error", "its error", detail=True),
    Column("mean_sojourn_s", "mean time to the end", "s", detail=True),
    Column("simulated_sojourn_s", "simulated", "s", detail=True),
)
SPEEDS = (
    Column("service", "service", words=True),
    Column("speed_op_s", "speed", "op/s", whole),
    Column("used_share", "used", form=per_cent),
)
CONTROLLERS = (
    Column("controller", "controller", words=True),
    Column("most_positions", "positions at most"),
    Column("positions", "positions of the hump"),
    Column("answer_s", "answer with these", "s", spare=1),
    Column("answer_margin_s", "margin", "s", spare=2),
    Column("table_s", "table ready", "s", spare=2),
    Column("used_share", "time used", "", per_cent, spare=2),
    Column("in_time", "in time", spare=1),
    Column("source", "source", detail=True, words=True),
)
CHANNELS = (
    Column("element", "element", words=True),
    Column("number", "number"),
    Column("digital_in", "digital in"),
    Column("analog_in", "analog in"),
    Column("digital_out", "digital out"),
    Column("analog_out", "analog out"),
)
RELIABILITY = (
    Column("figure", "figure", words=True),
    Column("value", "value", form=six_figures),
    Column("amount", "money", form=amount),
    Column("unit", "unit", words=True),
)


def sizing(found: ComputerResults) -> Iterator[Exhibit]:
    """Controllers of today, then the computer of the 1970s: waits, speeds, channels, words and memory."""
    sized, service = found.sized, found.config.settings.service
    rows = [controller_row(each) for each in sized.controllers]
    yield Table("controllers", "Controllers at the track", CONTROLLERS, rows, brief=True, bad=is_late)
    title = f"Waits at {service.speed_op_s:,.0f} op/s; long: above {service.long_wait_s:g} s"
    yield Table("waits", title, WAITS, [wait_row(each) for each in sized.waits], brief=True)
    yield Table("needed_speed", "Speed that is needed", SPEEDS, list(speed_rows(found)), brief=True)
    yield Table("channels", "Inputs and outputs", CHANNELS, list(channel_rows(sized)))
    yield memory_line(sized)
    yield Chart(
        "computer-waits",
        "Wait over speed",
        "Mean wait of a request for the begin of its service, and the chance of a long one, over the speed of the "
        "processor. Both are formulas; the table above has the simulation beside them at the configured speed.",
        lambda: _pictures().waits(found.config),
    )


def wait_row(each: TaskWait) -> Row:
    """Formulas and simulation of a task."""
    late = each.late_share
    return {
        "task": each.formula.task,
        "mean_wait_s": each.formula.start_s,
        "simulated_wait_s": each.simulated.start_s,
        "long_share": each.long_share.value,
        "long_share_error": each.long_share.error,
        "simulated_long_share": met(each.simulated.long_share),
        "late_share": None if late is None else late.value,
        "late_share_error": None if late is None else late.error,
        "mean_sojourn_s": each.formula.sojourn_s,
        "simulated_sojourn_s": each.simulated.sojourn_s,
    }


def met(share: Interval) -> Interval | None:
    """The share where the simulation met both kinds of requests; else its batches tell no interval."""
    return share if share.half_width > 0.0 else None


def speed_rows(found: ComputerResults) -> Iterator[Row]:
    """On demand by discipline, and in cycles."""
    sized, cycle = found.sized, found.config.settings.cycle
    for discipline, speed in sized.needed_op_s.items():
        yield {"service": f"on demand, {discipline.value}", "speed_op_s": speed}
    service = f"in cycles of {cycle.cycle_s:g} s"
    yield {"service": service, "speed_op_s": sized.cyclic_op_s, "used_share": sized.cyclic_used}


def controller_row(each: ControllerRow) -> Row:
    """One controller with all positions of the hump."""
    at = each.all_positions
    return {
        "controller": each.controller.name,
        "most_positions": each.most,
        "positions": at.positions,
        "answer_s": at.answer_s,
        "answer_margin_s": at.answer_margin_s,
        "table_s": at.table_s,
        "used_share": at.used_share,
        "in_time": at.in_time,
        "source": each.controller.source,
    }


def is_late(row: Row) -> bool:
    """The controller is too slow for the hump."""
    return not row["in_time"]


def channel_rows(sized: SizedComputer) -> Iterator[Row]:
    """By kind of element, of all, and of the source."""
    for each in sized.channels:
        yield {"element": each.kind.replace("_", " "), "number": each.count, **vars(each.all)}
    yield {"element": "all", **vars(total_channels(sized.channels))}
    yield {"element": "the source asked for", **vars(source_channels())}


def memory_line(sized: SizedComputer) -> Sentence:
    """Word length and memory."""
    kibibytes = {each.name.lower(): sized.memory.kibibytes(each) for each in Memory}
    told = ", ".join(f"{value:.3g} KiB {name}" for name, value in kibibytes.items())
    return Sentence(
        f"Words of {sized.word_bits} bits hold every quantity of the hump; memory: {told}. Load of the processor: "
        f"{per_cent(sized.load)}.",
        {"word_bits": sized.word_bits, "memory_kibibytes": kibibytes, "load": sized.load},
    )


def reliability(found: ComputerResults) -> Iterator[Exhibit]:
    """One computer and two."""
    yield Table("reliability", "Reliability", RELIABILITY, list(reliability_rows(found)))
    if found.reliable.why_none:
        yield Sentence(found.reliable.why_none)
    yield Chart(
        "computer-checks",
        "Checks",
        "Share of time in which no computer is ready, and what that costs in a year, over the interval between checks. "
        "Frequent checks cost time by hand, rare ones leave failures unnoticed.",
        lambda: _pictures().upkeep_interval(found.config),
    )


def reliability_rows(found: ComputerResults) -> Iterator[Row]:
    """Shares of time, losses of a year, and intervals between checks."""
    ready, money = found.reliable, f"{found.config.case.prices.currency}/a"
    unnoticed, checks, repair = ready.single_loss
    required = found.config.settings.reliability.required_availability
    for figure, value, unit in (
        ("one computer: share of time ready", ready.single_availability, ""),
        ("one computer: loss of a year", sum(ready.single_loss), money),
        ("of it unnoticed", unnoticed, money),
        ("of it checks", checks, money),
        ("of it repair", repair, money),
        ("two computers: share of time with a ready one", ready.duplex_availability, ""),
        ("two computers: loss of a year", ready.duplex_loss, money),
        ("best interval of one, by useful hours", ready.best_useful_h, "h"),
        ("best interval of one, by the calendar", ready.best_calendar_h, "h"),
        (f"longest period of two for {required:g}", ready.longest_period_h, "h"),
    ):
        yield {"figure": figure, "amount" if unit == money else "value": value, "unit": unit}


def _pictures() -> Any:
    from synth.computer import pictures  # matplotlib

    return pictures
