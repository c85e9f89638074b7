"""What the configuration of a control computer may contain: how fast it must be, and how reliable.

One frozen model a section, units in the key names; what it pays stands in `money_settings`.
"""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from plant_models.library.sourced_value import JUDGEMENT
from synth.configuration.computer.money_settings import (
    HandlingSettings,
    PriceSettings,
    RangeSettings,
    RatesSettings,
    TermsSettings,
    TrafficSettings,
    usual_ranges,
)
from synth.configuration.section import Section, setting
from synth.configuration.value_forms import Title

PRINTED = "[hump-computer-1970s], chapter 3"
RELIABLE = "[hump-computer-1970s], chapter 4"


class TaskSettings(Section):
    """A task that requests call up at random: a Poisson stream of them, each asking for a number of operations.

    `law` of that number: constant, erlang (of `stages`), exponential, hyperexponential (of `squared_cv` above 1).
    """

    name: str = Field(min_length=1, max_length=80)
    rate_per_s: float
    operations: float
    law: Literal["constant", "erlang", "exponential", "hyperexponential"] = "constant"
    stages: int | None = None
    squared_cv: float | None = None
    priority: int = Field(1, ge=1, le=1000)
    deadline_s: float | None = None


USUAL_TASKS = (
    TaskSettings(
        name="control of cuts, with feedback", rate_per_s=0.825, operations=8000.0, priority=1, deadline_s=0.1
    ),
)
"""Rate and operations of [hump-computer-1970s], chapter 3; constant, because only that law keeps both of its waits."""


class ServiceSettings(Section):
    """The processor that serves the tasks, and how long they may wait for it."""

    speed_op_s: float = setting(120_000.0, "op/s", 1.0, 1e15, "speed of the processor", f"{PRINTED}: with feedback")
    discipline: Literal["first-come", "relative", "absolute"] = "relative"
    mean_wait_s: float = setting(0.01, "s", 1e-9, 1e6, "longest mean wait for the begin of service", PRINTED)
    long_wait_s: float = setting(0.1, "s", 1e-9, 1e6, "what counts as a long wait", PRINTED)
    long_wait_share: float = setting(0.001, "1", 1e-6, 0.5, "share of requests that may wait longer", PRINTED)
    simulated_requests: int = setting(50_000, "1", 1000, 10_000_000, "requests of the simulation beside the formulas")


class CycleSettings(Section):
    """The other way of service: all objects in every cycle, whether something is new or not."""

    cycle_s: float = setting(1.0, "s", 1e-6, 1e6, "length of a cycle", PRINTED)
    operations: float = setting(
        500_000.0, "1", 1.0, 1e18, "operations of a cycle", f"{PRINTED}: what its speed of 1 000 000 op/s tells"
    )
    check_share: float = setting(
        1.0, "1", 0.0, 100.0, "time for checks, of that for the work", f"{PRINTED}: half of the time is left"
    )
    recovery_share: float = setting(0.0, "1", 0.0, 0.99, "part of the cycle kept to recover from errors", PRINTED)


class PositionSettings(Section):
    """What every retarder position asks of the controller at the track."""

    sample_s: float = setting(0.1, "s", 1e-4, 10.0, "sampling period", "of the library's radar")
    answer_s: float = setting(0.02, "s", 1e-4, 10.0, "time to a command", "computing delay of the library's radar")
    cut_s: float = setting(
        2.0, "s", 0.1, 1000.0, "shortest time between two cuts", f"{JUDGEMENT}: as cuts are kept apart"
    )
    table_s: float = setting(0.1, "s", 1e-4, 100.0, "time to choose a table for a cut", f"{JUDGEMENT}: one sample")


class ReliabilitySettings(Section):
    """How the computer fails and is looked after."""

    structure: Literal["single", "duplex"] = "duplex"
    failure_per_h: float = setting(
        0.0024, "1/h", 1e-9, 10.0, "failures of one computer that nobody notices at once",
        f"{JUDGEMENT}: makes the published losses of one computer; modern ones fail far less",
    )  # fmt: skip
    detection_per_h: float = setting(
        0.0, "1/h", 0.0, 1e6, "rate at which a computer notices its failure by itself", f"{JUDGEMENT}: it does not"
    )
    check_interval_h: float = setting(2.5, "h", 1e-3, 1e5, "hours between two checks", f"{RELIABLE}: 2 to 3 h")
    check_h: float = setting(
        0.02, "h", 1e-5, 1e3, "hours of a check, with what it finds", f"{JUDGEMENT}: about a minute"
    )
    repair_h: float = setting(1.0, "h", 1e-4, 1e4, "hours of a repair", f"{JUDGEMENT}: spare boards at hand")
    failed_check_to: Literal["maintenance", "repair"] = "maintenance"
    common_share: float = setting(
        0.05, "1", 0.0, 1.0, "share of failures that hit both computers at once", f"{JUDGEMENT}: 0.01 to 0.1 are usual"
    )
    required_availability: float = setting(
        0.9999, "1", 0.01, 0.999999, "availability that two computers must keep", f"{JUDGEMENT}: an hour in a year"
    )
    unnoticed_per_h: float = setting(
        5000.0, "currency/h", 0.0, 1e12, "loss of an hour in which nobody knows of the failure",
        f"{JUDGEMENT}: between a first and a second position that stay released (study control-computer)",
    )  # fmt: skip
    by_hand_per_h: float = setting(
        500.0, "currency/h", 0.0, 1e12, "loss of an hour of humping by hand", f"{JUDGEMENT}: humping is slower"
    )


class UncertaintySettings(Section):
    """How uncertain inputs are carried to the results."""

    draws: int = setting(10_000, "1", 200, 1_000_000, "draws of all uncertain inputs")
    sobol_points: int = setting(256, "1", 16, 65_536, "base points of the Sobol indices, a power of 2")
    seed: int = setting(18, "1", 0, 2**53, "seed of all draws")


class ComputerAcceptanceSettings(Section):
    """Limits; exit code 1 if one is missed. None: no limit."""

    pay_back_years: float | None = Field(None, gt=0.0, le=1000.0)
    loss_per_year: float | None = Field(None, ge=0.0)


class ComputerOutputSettings(Section):
    """What is written besides figures; changes no result and no hash."""

    plots: bool = Field(True, description="draw the pictures")
    report: bool = Field(True, description="write report.html")


class ComputerSettings(Section):
    """A whole configuration of a control computer; an empty one is the built-in default."""

    title: Title | None = None
    hump: str = "large"
    task: tuple[TaskSettings, ...] = Field(USUAL_TASKS, min_length=1, max_length=50, strict=False)
    service: ServiceSettings = ServiceSettings()
    cycle: CycleSettings = CycleSettings()
    position: PositionSettings = PositionSettings()
    reliability: ReliabilitySettings = ReliabilitySettings()
    prices: PriceSettings = PriceSettings()
    traffic: TrafficSettings = TrafficSettings()
    handling: HandlingSettings = HandlingSettings()
    rates: RatesSettings = RatesSettings()
    terms: TermsSettings = TermsSettings()
    range: tuple[RangeSettings, ...] = Field(usual_ranges(), max_length=100, strict=False)
    uncertainty: UncertaintySettings = UncertaintySettings()
    acceptance: ComputerAcceptanceSettings = ComputerAcceptanceSettings()
    output: ComputerOutputSettings = ComputerOutputSettings()
