"""What a hump trial leaves in its directory besides its batches: data, figures, pictures, pages, last the summary."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from synth.frame.picture.picture import Picture, picture_files
from synth.frame.results_directory import ResultsDirectory
from synth.present.hump_page.hump_page import hump_page
from synth.present.report.humping_report import HumpingReport, humping_page
from synth.yard.hump.event_log import to_log_csv
from synth.yard.humping.controlled_train import ControlledTrain
from synth.yard.humping.outcome_file import TRAINS, TrialTrains, to_npz
from synth.yard.humping.outcomes import TrainOutcomes
from synth.yard.humping.resolved_trial import ResolvedTrial
from synth.yard.humping.speed_program import locomotive_csv, speed_program, uncoupler_csv
from synth.yard.humping.traced_train import one_train
from synth.yard.humping.train_figures import TrainFigure, train_figures
from synth.yard.humping.train_trace import TrainTrace
from synth.yard.humping.trial import HumpTrial
from synth.yard.humping.trial_acceptance import TrialVerdict, judge_trains
from synth.yard.humping.trial_summary import figures_csv, trial_summary
from tuning_tables.canonical import canonical_json

FIGURES, PROGRAM, SHEET = "figures.csv", "locomotive.csv", "uncoupler.csv"
LOG = "events.csv"
PLAYER, REPORT = "hump.html", "report.html"
SHOWN_TRAIN = 0
"""The train that is drawn and played, and whose program and log are written."""

Say = Callable[[str], None]


@dataclass(frozen=True)
class TrialResult:
    """What trains of `trial`, which was made of `config`, have come to: `found`, with figures and verdict."""

    config: ResolvedTrial
    trial: HumpTrial
    found: TrainOutcomes
    figures: tuple[TrainFigure, ...]
    verdict: TrialVerdict
    created: str


def judged(config: ResolvedTrial, trial: HumpTrial, found: TrainOutcomes, created: str) -> TrialResult:
    """`found` with what it is worth."""
    figures = train_figures(found)
    return TrialResult(config, trial, found, figures, judge_trains(figures, config.settings.acceptance), created)


def write_trains(result: TrialResult, directory: ResultsDirectory, say: Say) -> dict[str, Any]:
    """Write everything but batches and inputs; the summary as written. Raises `OSError`.

    What all trains came to is on the disk before anything is made of the one that is shown: it cannot cost the figures.
    """
    config, output = result.config, result.config.settings.output
    directory.write_all(data_files(result))
    shown = one_train(result.trial, SHOWN_TRAIN)
    control, standing = shown.controlled(), shown.standing()
    if standing:
        first, fall_m = result.trial.routes.first_element
        say(f"warning: {standing} of the {len(shown.trains)} cuts of train {SHOWN_TRAIN + 1} stand before element "
            f"{first}; the track falls by {fall_m:.2f} m up to there")  # fmt: skip
    directory.write_all(shown_files(result, control))
    pictures: tuple[Picture, ...] = ()
    if output.plots or output.report:
        trace = shown.traced()
        pictures = drawn(result, trace)
        say(f"{len(pictures)} pictures drawn")
        if output.plots:
            directory.write_all(picture_files(pictures, "plots"))
        if output.report:
            directory.write(PLAYER, hump_page(config.hump, trace, category_names(config)).encode())
    if output.report:
        report = report_of(result, pictures, len(control.disagreements), directory.written)
        directory.write(REPORT, humping_page(report).encode())
    summary = trial_summary(config, result.found, result.figures, result.verdict, result.created, directory.written)
    directory.finish(canonical_json(summary) + b"\n")
    return summary


def data_files(result: TrialResult) -> dict[str, bytes]:
    """The outcomes by train, and the figures."""
    config = result.config
    return {
        TRAINS: to_npz(result.found, TrialTrains(config.routes, config.trains_sha256)),
        FIGURES: figures_csv(result.figures),
    }


def shown_files(result: TrialResult, control: ControlledTrain) -> dict[str, bytes]:
    """The program of the shown train, and what the hump control recorded of it."""
    program = speed_program(result.trial, SHOWN_TRAIN)
    return {
        PROGRAM: locomotive_csv(program),
        SHEET: uncoupler_csv(program),
        LOG: to_log_csv(control.events).encode(),
    }


def category_names(config: ResolvedTrial) -> tuple[str, ...]:
    """Names of the weight categories in their places."""
    return tuple(member.name for member in config.categories.members)


def drawn(result: TrialResult, trace: TrainTrace) -> tuple[Picture, ...]:
    """All pictures."""
    from synth.present.plots.humping.humping_pictures import outcome_pictures, train_pictures  # matplotlib

    config = result.config
    shown = train_pictures(trace, category_names(config))
    return (*outcome_pictures(config.hump, config.routes, result.found), *shown)


def report_of(
    result: TrialResult, pictures: tuple[Picture, ...], otherwise: int, hashes: Mapping[str, str]
) -> HumpingReport:
    """The page of `result`; `otherwise`: see `HumpingReport`."""
    config, limits = result.config, result.config.settings.acceptance.model_dump(exclude_none=True)
    return HumpingReport(
        title=config.title,
        created=result.created,
        config_sha256=config.sha256,
        verdict=f"{len(result.found)} trains of {int(result.found.cuts.sum())} cuts: {result.verdict.sentence}.",
        accepted=result.verdict.accepted if limits else None,
        figures=result.figures,
        pictures=pictures,
        parameters=config.parameters,
        aims=config.aims,
        tracks=tuple(route.track for route in config.routes.routes),
        player=PLAYER,
        log=LOG,
        otherwise=otherwise,
        file_hashes=hashes,
    )
