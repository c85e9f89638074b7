"""What a replay and a retune leave in their directories: book, pictures, report, and last of all the summary."""

from __future__ import annotations

from synth.book.summary import Document
from synth.configuration.resolved_config import ResolvedConfig
from synth.frame.picture.picture import Picture, picture_files
from synth.frame.results_directory import ResultsDirectory
from synth.present.report.measured_report import Figures, MeasuredReport, measured_page
from synth.yard.measured_passes.replay.replay import Replay
from synth.yard.measured_passes.replay.replay_summary import is_described, replay_sentences, replay_summary
from synth.yard.measured_passes.retune.retune import Retuned
from synth.yard.measured_passes.retune.retune_summary import retune_sentences, retune_summary
from tuning_tables import to_json, write_book
from tuning_tables.canonical import canonical_json

OF_BOTH = (
    "The plant is the model of this program with the numbers of the configuration; what the model lacks is not here.",
    "Intervals hold the chance of the passes named, and not that the yard changes after them.",
)
OF_REPLAY = (
    "Friction along the path and noise of the sensor are drawn anew; friction and resistance of a cut are as its log "
    "tells them.",
    "Rows must be the samples of the regulator: between samples a table that would command cannot have been followed.",
)
OF_RETUNE = (
    "A sensor that shows too much is not corrected by new tables: see sensor.bias_m_s among the numbers.",
    "A table counts as better where p passes Holm's rule over all cases at 2.5 %; the interval is of its case alone.",
    "New tables are made for the passes measured. After a repair of valves or sensors measure anew.",
)

Shape = tuple[str, bool, tuple[str, ...], tuple[Figures, ...], tuple[str, ...]]
"""Title, whether all is well, sentences, tables and limits of a report."""


def write_replay(found: Replay, config: ResolvedConfig, created: str, directory: ResultsDirectory) -> Document:
    """Write everything; the summary as written. Raises `OSError`."""
    from synth.present.plots.measured.replay_pictures import replay_pictures  # matplotlib

    rows = [[cut_id, why] for cut_id, why in found.left_out]
    figures = (Figures("Passes left out", ("cut", "why"), rows),) if rows else ()
    shape = (f"replay: {config.title}", is_described(found), replay_sentences(found), figures, OF_REPLAY + OF_BOTH)
    write_page(shape, config.sha256, created, tuple(replay_pictures(found)), directory)
    summary = replay_summary(found, config, created, directory.written)
    directory.finish(canonical_json(summary) + b"\n")
    return summary


def write_retune(found: Retuned, directory: ResultsDirectory) -> Document:
    """Write everything; the summary as written. No book where no case is better. Raises `OSError`."""
    from synth.present.plots.measured.retune_pictures import retune_pictures  # matplotlib

    if found.tables:
        directory.write_all({f"tables/{table.id}.json": to_json(table) for table in found.tables})
        with directory.writing("book.h5") as part:
            write_book(found.tables, part)
    title = f"retune: {found.config.title}"
    shape = (title, bool(found.changed), retune_sentences(found), figures_of(found), OF_RETUNE + OF_BOTH)
    pictures = tuple(retune_pictures(found)) if found.gains else ()
    write_page(shape, found.identified.sha256, found.created, pictures, directory)
    summary = retune_summary(found, directory.written)
    directory.finish(canonical_json(summary) + b"\n")
    return summary


def figures_of(found: Retuned) -> tuple[Figures, ...]:
    """Cases and numbers."""
    cases = [
        (f"{g.label} to {g.target_m_s:g} m/s", f"{g.old_rms_m_s:.4f}", f"{g.new_rms_m_s:.4f}",
         f"{g.ratio:.3f} [{g.ratio_ci95[0]:.3f}, {g.ratio_ci95[1]:.3f}]", f"{g.p_value:.2g}",
         "new" if g in found.changed else "kept: within noise")
        for g in found.gains
    ]  # fmt: skip
    numbers = []
    for i, one in enumerate(found.estimate.unknowns):
        low, high = found.estimate.interval(i)
        value = one.value(float(found.estimate.u[i]))
        numbers.append((one.key, f"{one.value(0.0):.4g}", f"{value:.4g}", f"{low:.4g} to {high:.4g}", one.unit))
    return (
        Figures("rms by case, m/s", ("case", "before", "after", "ratio [95 %]", "p, no better", "table"), cases),
        Figures("Numbers", ("key", "configured", "identified", "95 % interval", "unit"), numbers),
    )


def write_page(
    shape: Shape, sha256: str, created: str, pictures: tuple[Picture, ...], directory: ResultsDirectory
) -> None:
    """Write pictures and report."""
    title, good, sentences, figures, limits = shape
    directory.write_all(picture_files(pictures, "plots"))
    report = MeasuredReport(title, created, sha256, good, sentences, figures, pictures, limits, directory.written)
    directory.write("report.html", measured_page(report).encode())
