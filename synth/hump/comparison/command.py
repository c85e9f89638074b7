"""The command `hump compare`: figures of several runs on the same trains, and by how much they differ."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from synth.frame.command import Asked, Command, Head, Steps, Work
from synth.frame.exhibits import Chapter
from synth.frame.settings.toml_file import read_text
from synth.hump.comparison.compared_runs import Runs, config_in, runs_in
from synth.hump.comparison.options import CompareOptions
from synth.hump.comparison.played import played
from synth.hump.comparison.shown import figures
from synth.hump.limits_of_use import CHANCE_ONLY, MODEL_ONLY
from tuning_tables.canonical import canonical_json

LIMITS_OF_USE = (
    MODEL_ONLY,
    CHANCE_ONLY,
    "Several differences are told at once: of twenty that are none, one is outside its interval.",
)


def text_of(folder: Path, template: str) -> str:
    """The configuration of the run in `folder`."""
    return read_text(config_in(folder), template)


def resolve(asked: Asked[Path, CompareOptions]) -> Runs:
    """All runs; refused where they humped different trains."""
    return runs_in((asked.settings, *asked.options.others))


def head(runs: Runs) -> Head:
    """What is said of them: the parameters are those of the first."""
    first = runs[0].config
    names = [run.name for run in runs]
    told = {"format": "hump-comparison", "runs": [[run.name, run.config.sha256] for run in runs]}
    return Head(
        title=f"{', '.join(names[1:])} beside {names[0]}",
        canonical_json=canonical_json(told).decode("utf-8"),
        parameters=first.parameters,
        output=first.settings.output,
        warnings=tuple(dict.fromkeys(warning for run in runs for warning in run.config.warnings)),
    )


def compute(runs: Runs, work: Work) -> Runs:
    """Nothing is computed: figures and trains are made when they are shown."""
    work.progress.note(f"{len(runs)} runs of {len(runs[0].found)} trains read")
    return runs


def show(runs: Runs) -> Iterator[Chapter]:
    """Every figure of every run; then a few trains, which are humped again to be played."""
    yield Chapter("Figures", tuple(figures(runs)))
    if runs[0].config.settings.output.report:
        yield Chapter("Trains side by side", tuple(played(runs)))


COMMAND = Command(
    name="hump compare",
    read=lambda text, place: Path(place),
    options=CompareOptions,
    resolve=resolve,
    head=head,
    steps=lambda runs: Steps(1, "comparing", "comparisons"),
    compute=compute,
    show=show,
    limits_of_use=LIMITS_OF_USE,
    text=text_of,
)
