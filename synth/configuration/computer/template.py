"""A commented configuration of a control computer: every default written out with its unit, range and origin."""

from __future__ import annotations

from collections.abc import Iterator

from plant_models.library.hump_entry import hump_names
from synth.configuration.aim.template import setting_lines
from synth.configuration.computer.money_settings import (
    FigureSettings,
    HandlingSettings,
    PriceSettings,
    RangeSettings,
    RatesSettings,
    TermsSettings,
    TrafficSettings,
    usual_ranges,
)
from synth.configuration.computer.settings import (
    USUAL_TASKS,
    ComputerOutputSettings,
    ComputerSettings,
    CycleSettings,
    PositionSettings,
    ReliabilitySettings,
    ServiceSettings,
    UncertaintySettings,
)
from synth.configuration.config_template import quoted, source_lines, switch_lines

HEAD = """\
# Control computer of a hump (retarder-synth computer). Every line shows its default and may be left out.
# A comment says: unit; limits; origin. Sources stand at the end.
# ASSUMED: no citable source stands behind the number; replace it by that of your yard."""


def default_computer_toml() -> str:
    """The defaults as TOML; it reads back to the same configuration."""
    text = tuple(lines())
    return "\n".join((*text, *source_lines(text))) + "\n"


def lines() -> Iterator[str]:
    """The lines of the file."""
    yield HEAD
    yield '# title = "…"'
    yield "# whose elements are counted; the path of your own hump file, or one of the library:"
    yield f"# {', '.join(hump_names())}"
    yield f"hump = {quoted(ComputerSettings().hump)}"
    yield from task_lines()
    yield from ("", "[service]", '# who is next: "first-come", or by "relative" or "absolute" priorities')
    yield 'discipline = "relative"'
    yield from setting_lines("service", ServiceSettings())
    yield from ("", "[cycle]", *setting_lines("cycle", CycleSettings()))
    yield from ("", "[position]", "# what every retarder position asks of the controller at the track")
    yield from setting_lines("position", PositionSettings())
    yield from ("", "[reliability]", '# computers: "single" or "duplex"', 'structure = "duplex"')
    yield '# where a check of a failed computer leads: "maintenance", as the source has it, or "repair"'
    yield 'failed_check_to = "maintenance"'
    yield from setting_lines("reliability", ReliabilitySettings())
    yield from ("", "[prices]", "# of all amounts", f"currency = {quoted(PriceSettings().currency)}")
    yield from setting_lines("prices", PriceSettings())
    yield from ("", "[traffic]", *setting_lines("traffic", TrafficSettings()))
    yield from ("", "[handling]", *setting_lines("handling", HandlingSettings()))
    yield from rate_lines()
    yield from ("", "[terms]", *setting_lines("terms", TermsSettings()))
    yield from range_lines()
    yield from ("", "[uncertainty]", *setting_lines("uncertainty", UncertaintySettings()))
    yield from ("", "# Limits; exit code 1 if one is missed.", "# [acceptance]")
    yield "# pay_back_years = 4.0     # in 95 of 100 draws"
    yield "# loss_per_year = 100000.0 # by failures"
    yield from ("", "[output]", *switch_lines(ComputerOutputSettings))


def task_lines() -> Iterator[str]:
    """[[task]]."""
    yield from ("", "# Tasks: operations of a request are constant, erlang (stages), exponential or hyperexponential")
    yield "# (squared_cv above 1); priority 1 is the most urgent."
    for task in USUAL_TASKS:
        yield "[[task]]"
        for key, value in task.model_dump(exclude_none=True).items():
            yield f"{key} = {quoted(value) if isinstance(value, str) else repr(value)}"


def rate_lines() -> Iterator[str]:
    """[rates]."""
    yield from (
        "",
        "# The hump with the control of today, and by how much more of it with the new one, from two runs of",
    )
    yield "# 'hump simulate' over the same trains:"
    yield "# [rates]"
    yield '# today_trial = "out/today"'
    yield '# new_trial = "out/new"'
    yield "# or told: cars an hour while a train is humped; of all cuts: catch-ups, misrouted among them, those that"
    yield "# reached their track alone; of these: couplings above 1.39, 1.5 and 2 m/s; metres of gap a cut"
    for name in ("today", "change"):
        yield from (f"[rates.{name}]", *figure_lines(getattr(RatesSettings(), name)))


def figure_lines(figures: FigureSettings) -> Iterator[str]:
    """The figures of a hump."""
    for key, value in figures.model_dump().items():
        yield f"{key} = {value!r}"


def range_lines() -> Iterator[str]:
    """[[range]]."""
    yield from (
        "",
        "# How far inputs are known: uniform from low to high, triangular with mode, lognormal with 5 and 95 % of",
    )
    yield "# it below low and high, or measured: the value above with its 95 % interval. Those given here replace all."
    for each in usual_ranges():
        yield from ("[[range]]", *range_of(each))


def range_of(each: RangeSettings) -> Iterator[str]:
    """One range."""
    for key, value in each.model_dump(exclude_none=True).items():
        yield f"{key} = {quoted(value) if isinstance(value, str) else repr(value)}"
