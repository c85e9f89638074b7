"""The guide to the command line: which commands belong together, an example of each, and the page that tells of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from synth.frame.command_line import CommandGuide, Shown

TOP: Final = CommandGuide(
    "",
    {
        "Design tables": ("init", "tune", "aim", "sensors", "sweep"),
        "Check and understand them": (
            "inspect",
            "explore",
            "validate",
            "verify",
            "qualify",
            "loop",
            "bench",
            "sensitivity",
            "hardware",
        ),
        "The whole hump": ("hump", "computer"),
        "From measured passes": ("identify", "retune", "watch", "replay"),
        "For controllers": ("export",),
        "The project itself": ("study",),
    },
    {
        "tune": Shown("tune my.toml -o out", "reference/results.md"),
        "sensors": Shown("sensors my.toml --sensors 3-6", "how-to/point-sensors.md"),
        "aim": Shown("aim --hump my-hump.toml --track 7 -o out/aim", "how-to/aim.md"),
        "validate": Shown("validate out --passes 50000 --seed 7", "reference/limits.md"),
        "explore": Shown("explore out -o out/explore", "how-to/explore.md"),
        "sensitivity": Shown("sensitivity my.toml -o out/sensitivity", "how-to/sensitivity.md"),
        "hardware": Shown("hardware my.toml -o out/hardware", "explanation/any-time.md"),
        "computer": Shown("computer my-computer.toml -o out/computer", "how-to/control-computer.md"),
        "watch": Shown("watch log.csv --config my.toml -o out/watch", "how-to/watch.md"),
        "identify": Shown("identify log.csv --config my.toml -o out/identify", "how-to/identify.md"),
        "replay": Shown("replay log.csv --table out/book.h5 -o out/replay", "reference/pass-log.md"),
        "retune": Shown("retune log.csv --config my.toml -o out/retune", "how-to/retune.md"),
        "verify": Shown("verify out", "explanation/verification.md"),
        "qualify": Shown("qualify -o out/qualification", "how-to/qualify.md"),
        "inspect": Shown("inspect out -o out/pictures", "reference/table-format.md"),
        "loop": Shown("loop out -o out/loops", "how-to/loop.md"),
        "bench": Shown("bench out -o out/bench", "how-to/bench.md"),
        "export": Shown("export out --format st -o out/st", "how-to/controllers.md"),
        "init": Shown("init trial -o my-trial.toml", "how-to/own-types.md"),
        "study": Shown("study --list", "data/index.md"),
    },
)

HUMP: Final = CommandGuide(
    "hump",
    {
        "The hump": ("make", "check", "routes", "draw", "export", "design"),
        "Trains over it": ("simulate", "speed", "capacity", "compare"),
        "Its positions in service": ("watch",),
    },
    {
        "make": Shown("hump make my-short.toml -o out/my", "reference/hump-file.md"),
        "check": Shown("hump check my-hump.toml", "reference/hump-file.md"),
        "routes": Shown("hump routes my-hump.toml", "reference/hump-file.md"),
        "draw": Shown("hump draw my-hump.toml -o out/hump --track 7", "reference/hump-file.md"),
        "export": Shown("hump export my-hump.toml --format xlsx -o out/sheets", "reference/hump-file.md"),
        "design": Shown("hump design my-hump.toml --speed 1.4", "how-to/hump-trials.md"),
        "simulate": Shown("hump simulate my-trial.toml --trains 1000 -o out/mine", "how-to/hump-trials.md"),
        "speed": Shown("hump speed my-trial.toml --train 3", "how-to/hump-trials.md"),
        "capacity": Shown("hump capacity my-trial.toml --exit-std 0.35,0.2,0.05", "how-to/hump-trials.md"),
        "watch": Shown("hump watch my-yard.toml -o out/yard", "how-to/watch.md"),
        "compare": Shown("hump compare out/today out/new -o out/compared", "how-to/hump-trials.md"),
    },
)

SWEEP: Final = CommandGuide(
    "sweep",
    {"Commands": ("run", "status", "failed")},
    {
        "run": Shown("sweep run my-sweep.toml -o out/sweep", "how-to/sweep.md"),
        "status": Shown("sweep status out/sweep", "how-to/sweep.md"),
        "failed": Shown("sweep failed out/sweep", "how-to/sweep.md"),
    },
)

GUIDES: Final[Mapping[str, CommandGuide]] = {guide.words: guide for guide in (TOP, HUMP, SWEEP)}
"""By the words of the group."""
