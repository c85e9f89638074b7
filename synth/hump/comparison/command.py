"""The command `hump compare`: figures of several runs on the same trains, and by how much they differ."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from synth.frame.command import Asked, Command, Head, Steps, Work
from synth.frame.exhibits import Chapter
from synth.frame.settings.toml_file import read_text
from synth.hump.comparison.options import CompareOptions
from synth.hump.limits_of_use import CHANCE_ONLY, MODEL_ONLY

if TYPE_CHECKING:
    from synth.hump.comparison.compared_runs import HumpedRun

LIMITS_OF_USE = (
    MODEL_ONLY,
    CHANCE_ONLY,
    "Several differences are told at once: of twenty that are none, one is outside its interval.",
)


@dataclass(frozen=True)
class Compared:
    """The runs, the first one being what the others are compared with."""

    runs: tuple[HumpedRun, ...]


def text_of(folder: Path, template: str) -> str:
    """The configuration of the run in `folder`."""
    from synth.hump.comparison.compared_runs import config_in

    return read_text(config_in(folder), template)


def read(text: str, place: str) -> Path:
    """The directory of the first run."""
    return Path(place)


def resolve(asked: Asked[Path, CompareOptions]) -> Compared:
    """All runs; refused where they humped different trains."""
    from synth.hump.comparison.compared_runs import runs_in

    return Compared(runs_in((asked.settings, *asked.options.others)))


def head(asked: Compared) -> Head:
    """What is said of them: the parameters are those of the first."""
    from tuning_tables.canonical import canonical_json

    first = asked.runs[0].config
    names = [run.name for run in asked.runs]
    told = {"format": "hump-comparison", "runs": [[run.name, run.config.sha256] for run in asked.runs]}
    return Head(
        title=f"{', '.join(names[1:])} beside {names[0]}",
        canonical_json=canonical_json(told).decode("utf-8"),
        parameters=first.parameters,
        output=first.settings.output,
        warnings=tuple(dict.fromkeys(warning for run in asked.runs for warning in run.config.warnings)),
    )


def steps(asked: Compared) -> Steps:
    """A step for all."""
    return Steps(1, "comparing", "comparisons")


def compute(asked: Compared, work: Work) -> Compared:
    """Nothing is computed: figures and trains are made when they are shown."""
    work.progress.note(f"{len(asked.runs)} runs of {len(asked.runs[0].found)} trains read")
    return asked


def show(compared: Compared) -> Iterator[Chapter]:
    """Every figure of every run; then a few trains, which are humped again to be played."""
    from synth.hump.comparison.played import played
    from synth.hump.comparison.shown import figures

    yield Chapter("Figures", tuple(figures(compared.runs)))
    if compared.runs[0].config.settings.output.report:
        yield Chapter("Trains side by side", tuple(played(compared.runs)))


COMMAND = Command(
    name="hump compare",
    read=read,
    options=CompareOptions,
    resolve=resolve,
    head=head,
    steps=steps,
    compute=compute,
    show=show,
    limits_of_use=LIMITS_OF_USE,
    text=text_of,
)
