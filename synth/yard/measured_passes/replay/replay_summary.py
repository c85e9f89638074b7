"""A replay in sentences, and as a document for programs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict
from importlib.metadata import version
from typing import Any

import numpy as np

from synth.book.summary import Document, plain
from synth.configuration.resolved_config import ResolvedConfig
from synth.yard.measured_passes.replay.replay import Replay
from synth.yard.measured_passes.replay.rule_agreement import RuleAgreement

VERSION = 1

DOUBTFUL_P = 0.01
"""Below this p value the configuration is said not to describe the log."""


def is_described(found: Replay) -> bool:
    """Nothing speaks against the configuration."""
    return not found.uniformity.p_value < DOUBTFUL_P  # NaN is not


def replay_sentences(found: Replay) -> tuple[str, ...]:
    """What was found, the most important first."""
    d, test = found.difference, found.uniformity
    told = []
    if d.passes:
        low, high = d.rms_m_s.ci95
        told.append(
            f"rms of exit less target on {d.passes} cuts: {d.own_rms_m_s:.4f} m/s under the tables of the log, "
            f"{d.other_rms_m_s:.4f} m/s under the others; difference {d.rms_m_s.value:+.4f} [{low:+.4f}, {high:+.4f}] "
            f"m/s (95 %), carried by {d.effective:.0f} passes"
        )
        over_low, over_high = d.overspeed.ci95
        told.append(
            f"more than 0.3 m/s too fast: {100.0 * d.own_overspeed:.2f} % and {100.0 * d.other_overspeed:.2f} %; "
            f"difference {100.0 * d.overspeed.value:+.2f} [{100.0 * over_low:+.2f}, {100.0 * over_high:+.2f}] %"
        )
    else:
        told.append("no pass has a table in both books: nothing is compared")
    told.append(f"the tables of the log command as logged at {agreement_words(found.own_agreement)}")
    told.append(f"the other tables command as logged at {agreement_words(found.agreement)}")
    if test.n:
        word = "agree with" if is_described(found) else "do not agree with"
        told.append(
            f"{test.n} measured exits {word} those predicted for the tables of the log (Kolmogorov–Smirnov test of "
            f"their ranks: p = {test.p_value:.2g})"
        )
    for why, count in Counter(why for _, why in found.left_out).most_common():
        told.append(f"left out: {count} passes, {why}")
    return tuple(told)


def agreement_words(agreement: RuleAgreement) -> str:
    """Shares of rows, commands, and passes."""
    same, asked = agreement.rows
    if not asked:
        return "no reading: none has a table"
    commands, all_commands = agreement.commands
    differing = int((agreement.first_differing >= 0).sum())
    return f"{same} of {asked} readings and {commands} of {all_commands} commands; {differing} passes differ somewhere"


def replay_summary(found: Replay, config: ResolvedConfig, created: str, file_hashes: Mapping[str, str]) -> Document:
    """The document; None stands for what is not known."""
    document = {
        "format": "replay-summary",
        "version": VERSION,
        "created": created,
        "generator": {"name": "retarder-synth", "version": version("retarder-synth"), "config_sha256": config.sha256},
        "title": config.title,
        "sentences": replay_sentences(found),
        "agreement": {"own": agreement_of(found.own_agreement), "other": agreement_of(found.agreement)},
        "difference": asdict(found.difference),
        "uniformity": asdict(found.uniformity),
        "left_out": [{"cut_id": cut_id, "why": why} for cut_id, why in found.left_out],
        "passes": [pass_of(found, number) for number in range(len(found.passes))],
        "files": dict(file_hashes),
    }
    plain_document: Document = plain(document)
    return plain_document


def agreement_of(agreement: RuleAgreement) -> dict[str, Any]:
    """Counts of rows and of commands."""
    return {
        "rows": dict(zip(("same", "asked"), agreement.rows, strict=True)),
        "commands": dict(zip(("same", "all"), agreement.commands, strict=True)),
        "passes_that_differ": int((agreement.first_differing >= 0).sum()),
    }


def pass_of(found: Replay, number: int) -> dict[str, Any]:
    """One pass; the first row that differs is counted from its first row, 0."""
    log = found.passes.log
    first = int(found.agreement.first_differing[number])
    own, other = found.own, found.other
    return {
        "cut_id": log.cut_id[number],
        "class": found.passes.plants[int(found.passes.class_of[number])][0],
        "target_m_s": known(log.target_m_s[number]),
        "measured_m_s": known(found.measured.speed_m_s[number]),
        "own": {"mean_m_s": known(own.mean_m_s[number]), "band80_m_s": [known(x) for x in own.band_m_s[number]]},
        "other": {"mean_m_s": known(other.mean_m_s[number]), "band80_m_s": [known(x) for x in other.band_m_s[number]]},
        "rank": known(found.rank[number]),
        "first_differing_row": None if first < 0 else first - int(log.first_row[number]),
    }


def known(value: float) -> float | None:
    """None for NaN."""
    return None if np.isnan(value) else float(value)
