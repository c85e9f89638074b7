"""What `identify` tells: sentences for a person, a document for programs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Final

import numpy as np

from synth.yard.measured_passes import unknowns as asked
from synth.yard.measured_passes.fitting_passes import FittingPasses
from synth.yard.measured_passes.identifiability import Finding
from synth.yard.measured_passes.identify import Identified
from synth.yard.measured_passes.residual_tests import MOTION, ResidualTest
from tuning_tables.pass_log.path_resets import path_resets_m

CONFIG: Final = "config.toml"

VERSION: Final = 1


def identify_sentences(found: Identified) -> tuple[str, ...]:
    """The answer, most important first."""
    return tuple(_sentences(found))


def _sentences(found: Identified) -> Iterator[str]:
    told = [finding for finding in found.findings if finding.identified]
    moved = [finding for finding in told if not finding.within]
    yield (
        f"{len(found.passes)} passes tell {len(told)} of {len(found.findings)} numbers; of {len(moved)} what was taken "
        "before is outside the 95 % interval."
    )
    yield from bias_sentences(found.findings)
    yield from log_sentences(found.passes, found.estimate.values)
    yield (
        f"Surprises of the readings, over what is expected (1 where the numbers are right): "
        f"{found.before.surprise_rms:.2f} with the numbers before, {found.after.surprise_rms:.2f} with these."
    )
    if not found.wrong:
        yield "No test says that the model does not hold."
    for test in found.wrong:
        yield f"The model does not hold: {test_sentence(test)} (p = {test.p:.1g})."
    undecided = sum(test.may_matter and test not in found.wrong for test in found.tests)
    if undecided:
        yield (
            f"{undecided} of {len(found.tests)} tests {'is' if undecided == 1 else 'are'} not decided: the interval "
            "reaches beyond what matters. More passes make it shorter."
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


def test_sentence(test: ResidualTest) -> str:
    """The effect, its size with the interval, and from where on it matters."""
    low, high = test.interval
    effect = test.effect
    return (
        f"{effect.looks_for}, by {test.size:+.2g} [{low:+.2g}, {high:+.2g}] {effect.unit}; it matters from "
        f"{effect.matters_from:g}"
    )


def other_tests(found: Identified) -> tuple[str, ...]:
    """A line for each test that does not say that the model is wrong."""
    return tuple(f"{verdict(test, False)}: {test_sentence(test)}" for test in found.tests if test not in found.wrong)


def verdict(test: ResidualTest, fails: bool) -> str:
    """What a test comes to."""
    if fails:
        return "the model does not hold"
    return "not decided" if test.may_matter else "holds"


def identify_summary(found: Identified, created: str, hashes: dict[str, str]) -> dict[str, Any]:
    """The document."""
    return {
        "format": "identify-summary",
        "version": VERSION,
        "created": created,
        "config_sha256": found.config.sha256,
        "passes": len(found.passes),
        "released_vents": found.passes.released_vents,
        "log_likelihood": found.estimate.log_likelihood,
        "sentences": list(identify_sentences(found)),
        "numbers": [number(finding) for finding in found.findings],
        "not_to_be_told": list(found.reasons),
        "tests": [tested(test, test in found.wrong) for test in found.tests],
        "surprise_rms": {"before": found.before.surprise_rms, "after": found.after.surprise_rms},
        "files": hashes,
    }


def number(finding: Finding) -> dict[str, Any]:
    """One number."""
    return {
        "key": finding.key,
        "unit": finding.unit or "1",
        "before": finding.before,
        "value": finding.value,
        "ci95": list(finding.interval),
        "identified": finding.identified,
        "left_of_what_was_unknown": finding.left,
        "told_together_with": [{"key": key, "correlation": value} for key, value in finding.with_others],
    }


def tested(test: ResidualTest, fails: bool) -> dict[str, Any]:
    """One test."""
    return {
        "looks_for": test.effect.looks_for,
        "unit": test.effect.unit,
        "size": test.size,
        "ci95": list(test.interval),
        "matters_from": test.effect.matters_from,
        "z": test.z,
        "p": test.p,
        "verdict": verdict(test, fails),
        "model_wrong": fails,
    }
