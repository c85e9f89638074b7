"""What is shown of identified numbers: each with its interval, what cannot be told, the tests of the model, files."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Final

import numpy as np

from synth.frame.exhibits import Chart, Column, Exhibit, File, Row, Sentence, Table
from synth.frame.interval import Interval
from synth.frame.printed_numbers import four_figures
from synth.logs import unknowns as asked
from synth.logs.fitting_passes import FittingPasses
from synth.logs.identify import Finding, Identified
from synth.logs.residual_tests import MOTION, ResidualTest
from synth.retarder.configuration.config_file import ConfigSource
from tuning_tables.pass_log.pass_log import path_resets_m

CONFIG: Final = "config.toml"

STAYS: Final = "no: stays as it was"


def signed(value: float) -> str:
    """Two figures with their sign."""
    return f"{value:+.2g}"


NUMBERS: Final = (
    Column("key", "key", words=True),
    Column("before", "before", form=four_figures),
    Column("value", "identified", form=four_figures),
    Column("unit", "unit", words=True, spare=1),
    Column("identified", "decided", words=True, spare=2),
    Column("left", "left of what was unknown", detail=True),
)
TOGETHER: Final = (
    Column("key", "number", words=True, once=True),
    Column("with", "identified together with", words=True),
    Column("correlation", "correlation of the errors", form="{:+.3f}".format),
)
TESTS: Final = (
    Column("looks_for", "the test looks for", words=True),
    Column("size", "effect", form=signed),
    Column("matters_from", "matters from", form=four_figures),
    Column("unit", "unit", words=True),
    Column("z", "z", form="{:+.1f}".format, spare=2),
    Column("p", "p", form="{:.2g}".format, spare=1),
    Column("verdict", "verdict", words=True),
)


def numbers(found: Identified) -> Iterator[Exhibit]:
    """How much is told, the numbers, and what no such log tells."""
    yield Sentence(told_sentence(found), brief=True)
    yield from (Sentence(sentence, brief=True, to_do=True) for sentence in bias_sentences(found.findings))
    yield Sentence(f"Make tables with these numbers: retarder-synth tune {CONFIG}.", to_do=True)
    for sentence in log_sentences(found.passes, found.estimate.values):
        yield Sentence(sentence, brief=True)
    yield Sentence(
        f"Innovations of the readings, over what is expected (1 where the numbers are right): "
        f"{found.before.innovation_rms:.2f} with the numbers before, {found.after.innovation_rms:.2f} with these.",
        {
            "passes": len(found.passes),
            "released_vents": found.passes.released_vents,
            "log_likelihood": found.estimate.log_likelihood,
            "innovation_rms": {"before": found.before.innovation_rms, "after": found.after.innovation_rms},
        },
        brief=True,
    )
    n = len(found.passes)
    yield Table("numbers", "Numbers", NUMBERS, [number_row(each, n) for each in found.findings], brief=True)
    yield from pictures(found)
    yield Table("told_together", "Numbers that are identified together", TOGETHER, list(together_rows(found.findings)))
    yield Sentence(" ".join(found.reasons), {"not_to_be_told": found.reasons})


def told_sentence(found: Identified) -> str:
    """How many numbers are told, and how many are not what they were."""
    told = [finding for finding in found.findings if finding.identified]
    moved = [finding for finding in told if not finding.within]
    return (
        f"{len(found.passes)} passes identify {len(told)} of {len(found.findings)} numbers; of {len(moved)} what was "
        "taken before is outside the 95 % interval."
    )


def bias_sentences(findings: Iterable[Finding]) -> Iterator[str]:
    """What the sensor shows too much, where that matters: less is not worth the adjusting."""
    for finding in findings:
        low, high = finding.interval
        if finding.key == asked.BIAS and max(low, -high) > MOTION.matters_from:
            yield f"The speed sensor shows {finding.value:+.3f} [{low:+.3f}, {high:+.3f}] m/s too much: adjust it."


def log_sentences(passes: FittingPasses, values: Mapping[str, float]) -> Iterator[str]:
    """What is otherwise in the log than in the model, and how it was taken; `values`: the identified numbers."""
    log = passes.log
    reset = path_resets_m(log.time_s, log.path_m, log.speed_m_s, log.first_row)
    rows = np.flatnonzero(reset)
    if len(rows):
        in_passes = len(np.unique(log.pass_of_row[rows]))
        yield (
            f"The path was set anew {len(rows)} times, in {in_passes} of {len(log)} passes, "
            f"by {np.max(np.abs(reset)):.2f} m at most: the rows ahead are shifted by as much."
        )
    if passes.released_vents:
        drive = passes.plant.position.pneumatics
        band, supply = values[asked.DEAD_BAND], drive.supply_pressure_kpa - drive.exhaust_pressure_kpa
        sooner_s = values[asked.FILL] * math.log(supply / (supply - band))
        yield (
            "The released drive is open to the air: it rests at the pressure of the air, not at the edge of the dead "
            f"band. Simulator and tables take it to rest at the edge, and to fill {1e3 * sooner_s:.0f} ms too soon."
        )


def number_row(finding: Finding, n: int) -> Row:
    """One number, told by `n` passes."""
    return {
        "key": finding.key,
        "before": finding.before,
        "value": Interval(finding.value, *finding.interval, n),
        "unit": finding.unit or "1",
        "identified": "yes" if finding.identified else STAYS,
        "left": finding.left,
    }


def together_rows(findings: Iterable[Finding]) -> Iterator[Row]:
    """Pairs whose errors go together."""
    for finding in findings:
        for key, correlation in finding.with_others:
            yield {"key": finding.key, "with": key, "correlation": correlation}


def pictures(found: Identified) -> Iterator[Exhibit]:
    """What changed, how the drive answers, and friction from cut to cut."""
    yield Chart(
        "identify-numbers",
        "What was taken before, and what the passes say",
        "Distance from what was taken before, in standard deviations of what was known (grey band: one of them), "
        "with 95 % intervals. Hollow: the passes do not identify the number, and it stays as it was.",
        lambda: _pictures().numbers(found),
    )
    if found.passes.log.has_gauge:
        yield Chart(
            "identify-pressures",
            "Pressure after a command",
            "Mean gauge pressure after the commands of each kind (points), and what the numbers before "
            "(dashed) and the identified ones (lines) make of the same commands.",
            lambda: _pictures().pressures(found),
        )
    yield Chart(
        "identify-friction",
        "Friction of the cuts, and innovations of the readings",
        "Left: friction of each cut as its own pass shows it, and the identified law. "
        "Right: innovations of the readings over what is expected, and the normal law that they follow if all "
        "is right.",
        lambda: _pictures().friction(found),
    )


def model(found: Identified) -> Iterator[Exhibit]:
    """The tests of the model."""
    n = len(found.passes)
    rows = [test_row(test, test in found.wrong, n) for test in found.tests]
    yield Table("tests", "Tests of the model", TESTS, rows, brief=True, bad=fails)
    undecided = sum(test.may_matter and test not in found.wrong for test in found.tests)
    if undecided:
        yield Sentence(
            f"{undecided} of {len(found.tests)} tests {'is' if undecided == 1 else 'are'} not decided: the interval "
            "reaches beyond what matters. More passes make it shorter.",
            brief=True,
        )


def test_row(test: ResidualTest, is_wrong: bool, n: int) -> Row:
    """One test, clustered by `n` passes."""
    return {
        "looks_for": test.effect.looks_for,
        "size": Interval(test.size, *test.interval, n),
        "matters_from": test.effect.matters_from,
        "unit": test.effect.unit,
        "z": test.z,
        "p": test.p,
        "verdict": verdict(test, is_wrong),
        "model_wrong": is_wrong,
    }


def fails(row: Row) -> bool:
    """The test says that the model does not hold."""
    return bool(row["model_wrong"])


def test_sentence(test: ResidualTest) -> str:
    """The effect, its size with the interval, and from where on it matters."""
    low, high = test.interval
    effect = test.effect
    return (
        f"{effect.looks_for}, by {test.size:+.2g} [{low:+.2g}, {high:+.2g}] {effect.unit}; it matters from "
        f"{effect.matters_from:g}"
    )


def verdict(test: ResidualTest, is_wrong: bool) -> str:
    """What a test comes to."""
    if is_wrong:
        return "the model does not hold"
    return "not decided" if test.may_matter else "holds"


def files(identified: ConfigSource) -> Iterator[Exhibit]:
    """The configuration with the numbers, and the own types that it names."""
    yield Sentence(f"{CONFIG} is the configuration with the numbers that are identified, each with its origin.")
    for name, content in identified.files(CONFIG).items():
        yield File(name, content)


def _pictures() -> Any:
    from synth.logs import identify_pictures  # matplotlib

    return identify_pictures
