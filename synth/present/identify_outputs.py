"""What identification leaves in its directory: the configuration, pictures, report, and last of all the summary."""

from __future__ import annotations

from typing import Final

from synth.book.summary import Document
from synth.frame.results_directory import ResultsDirectory
from synth.present.measured_outputs import Shape, write_page
from synth.present.report.measured_report import Figures
from synth.yard.measured_passes.config_source import ConfigSource
from synth.yard.measured_passes.identified_config import config_files, identified
from synth.yard.measured_passes.identify import Identified
from synth.yard.measured_passes.identify_summary import CONFIG, identify_sentences, identify_summary, verdict
from tuning_tables.canonical import canonical_json

TEST_HEADS: Final = ("the test looks for", "effect", "95 % interval", "matters from", "unit", "z", "p", "verdict")

LIMITS: Final = (
    "The numbers are those of the model of this program. Where a test says that the model does not hold, they are what "
    "comes nearest to the passes, and the intervals hold for that.",
    "The intervals hold for the plant as it was while the log was made.",
)


def write_identified(found: Identified, source: ConfigSource, created: str, directory: ResultsDirectory) -> Document:
    """Write everything; the summary as written. Raises `OSError`."""
    from synth.present.plots.measured.identify_pictures import identify_pictures  # matplotlib

    new = identified(source, found.estimate, found.origin)
    directory.write_all(config_files(new, CONFIG))
    shape: Shape = (
        f"identify: {found.config.title}", not found.wrong, identify_sentences(found), figures_of(found),
        (*found.reasons, *LIMITS),
    )  # fmt: skip
    write_page(shape, new.resolved().sha256, created, tuple(identify_pictures(found)), directory)
    summary = identify_summary(found, created, directory.written)
    directory.finish(canonical_json(summary) + b"\n")
    return summary


def figures_of(found: Identified) -> tuple[Figures, ...]:
    """Numbers and tests."""
    numbers = [
        (f.key, f"{f.before:.4g}", f"{f.value:.4g}", f"{f.interval[0]:.4g} to {f.interval[1]:.4g}", f.unit,
         "yes" if f.identified else "no: stays as it was", ", ".join(key for key, _ in f.with_others))
        for f in found.findings
    ]  # fmt: skip
    tests = [
        (t.effect.looks_for, f"{t.size:+.2g}", "{:+.2g} to {:+.2g}".format(*t.interval), f"{t.effect.matters_from:g}",
         t.effect.unit, f"{t.z:+.1f}", f"{t.p:.2g}", verdict(t, t in found.wrong))
        for t in found.tests
    ]  # fmt: skip
    heads = ("key", "before", "identified", "95 % interval", "unit", "told", "told together with")
    return (
        Figures("Numbers", heads, numbers),
        Figures("Does the model hold?", TEST_HEADS, tests),
    )
