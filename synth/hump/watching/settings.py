"""What the file of a yard that is watched may contain."""

from __future__ import annotations

from typing import Annotated, Final

from pydantic import AfterValidator, Field, model_validator

from plant_models.errors import require
from plant_models.hump.ranges import RETARDERS
from plant_models.library.sourced_value import JUDGEMENT
from synth.frame.settings.numbers import Title, printable
from synth.frame.settings.section import OutputSettings, Section, choice, many, optional, setting
from synth.frame.settings.template import NOTHING, template
from synth.hump.options import CountedTrains

MOST_POSITIONS: Final = 1000


def file_name(text: str) -> str:
    """Validator: `text` itself; `ValueError` where it cannot be the name of a file."""
    if text.startswith(".") or set(text) & set('/\\:*?"<>|'):
        raise ValueError('it must not begin with a dot, nor hold any of / \\ : * ? " < > |, as a file has that name')
    return text


PositionName = Annotated[str, Field(min_length=1, max_length=63), AfterValidator(printable), AfterValidator(file_name)]
"""Also the name of a file."""


class WatchedPositionSettings(Section):
    """One retarder position. What is left out is as above."""

    name: PositionName = choice(..., "what people call it")
    retarder: int | None = optional(
        "", RETARDERS.first, RETARDERS.last, "its number in the hump of the trial; left out: its drifts are not priced",
        401,
    )  # fmt: skip
    logs: str | None = choice(None, "its passes, a file or a folder of files", "logs/my-position")
    config: str | None = choice(None, "the configuration with its plant", "my-position.toml")
    mapping: str | None = choice(None, "names and units of foreign columns", "my-mapping.toml")


class FalseAlarmSettings(Section):
    """How seldom the whole yard may give a false alarm; the limit of every sum follows."""

    nights: int = setting(20, "1", 1, 100_000, "nights between two false alarms of the yard, at least")
    passes: int = setting(
        200,
        "1",
        1,
        100_000,
        "passes of a position in a night",
        f"{JUDGEMENT}: a park position has fewer, a master more",
    )


class CostSettings(CountedTrains):
    """Trains that a drift is priced on, humped with it and without, and what counts."""

    number: int = setting(200, "1", 20, 100_000, "trains that a drift is priced on; 10 shifts of them at least")
    cars_per_overspeed: float = setting(
        1.0, "1", 0.0, 1000.0, "cars to be humped again that weigh as much as one over-speed coupling",
        f"{JUDGEMENT}: both are a car that somebody must look after",
    )  # fmt: skip
    cars_per_gap_m: float = setting(
        0.01, "1/m", 0.0, 1000.0, "the same of a metre of gap",
        f"{JUDGEMENT}: 14 m keep one car out until the track is pushed up, a seventh of the work of humping it again",
    )  # fmt: skip


class YardWatchSettings(Section):
    """The positions of a yard, and where their passes are."""

    title: Title | None = choice(None, "title of the page", "My yard")
    trial: str | None = choice(
        None, "a hump trial, which tells what a drift costs; left out: nothing does", "trial.toml"
    )
    logs: str = choice("logs/{name}", "passes of a position, a file or a folder, {name} being its name")
    config: str | None = choice(None, "the configuration with the plant; left out: the built-in one", "my.toml")
    mapping: str | None = choice(None, "names and units of foreign columns of the logs", "mapping.toml")
    false_alarms: FalseAlarmSettings = FalseAlarmSettings()
    cost: CostSettings = CostSettings()
    position: tuple[WatchedPositionSettings, ...] = many(..., 1, MOST_POSITIONS, "tables [[position]]")
    output: OutputSettings = OutputSettings()

    @model_validator(mode="after")
    def _each_once(self) -> YardWatchSettings:
        for what in ("name", "retarder"):
            given = [getattr(each, what) for each in self.position if getattr(each, what) is not None]
            twice = next((each for place, each in enumerate(given) if each in given[:place]), None)
            require(twice is None, f"position: {what} {twice!r} is there twice; give each position its own")
        return self

    @property
    def run_length(self) -> float:
        """Passes of one position between two false alarms, at least, so that the yard has them as seldom as asked.

        The rates of all positions add up.
        """
        return float(self.false_alarms.nights * self.false_alarms.passes * len(self.position))


EXAMPLE: Final = YardWatchSettings(position=(WatchedPositionSettings(name="401"), WatchedPositionSettings(name="402")))

EXAMPLE_LINES = (
    "Two positions as an example:\n# put those of your yard in their place. A name is all that a position needs."
)


def example_yard_toml() -> str:
    """Two positions with the built-in plant."""
    return template(EXAMPLE, "Yard that is watched", "hump watch", NOTHING, (), EXAMPLE_LINES)
