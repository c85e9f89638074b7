"""Extreme but legal configurations through whole runs: `python -m tests.attack.legal tune --number 500`.

A template says of every setting what it may be. Some settings of each configuration are at the ends of that, or a
little or far beyond, where physics may still allow it. A run ends with 0 or 1, or is refused in one sentence.
"""

from __future__ import annotations

import argparse
import os
import random
import re
import shutil
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from synth.cli.file_kinds import FILE_KINDS
from tests.attack.forks import Ended, Limits, contents, forked, warmed
from tests.attack.processes import LONGEST
from tests.golden.orders import INPUTS
from tests.golden.record import SURROUNDINGS
from tests.system.conftest import CLASS

SECTION: Final = re.compile(r"^(?:# )?\[+([\w.]+)\]+$")
SETTING: Final = re.compile(r"^(?:# )?(\w+) = (\S.*?)(?:  # (.*))?$")
NUMBER: Final = r"-?\d[\d.]*(?:e[+-]?\d+)?"
LIMITS: Final = re.compile(rf"; ({NUMBER}) to ({NUMBER});")
WORDS: Final = re.compile(r"; (?:one of )?([\w-]+(?:, [\w-]+)* or [\w-]+|[\w-]+(?:, [\w-]+)+)(?:,|;|$)")
NO_FIGURE: Final = re.compile(r"\b(?:nan|NaN|[Ii]nf|Infinity)\b")
NO_NUMBER: Final = re.compile(r"\bnan\b", re.IGNORECASE)
"""In a sheet, where inf says never."""
EFFORT: Final = re.compile(
    "passes|seed|path_step_m|speed_step_m_s|transient_step_s|.*_scenarios|path_levels|degree|number|cuts|design_cuts|"
    "draws|sobol_points|simulated_requests|shift_trains|threads|choices|step_m_s"
)
"""What only costs time; it stays as it is in the smallest form."""

LIMITS_OF_RUN: Final = Limits(memory_bytes=8 * 2**30)


@dataclass(frozen=True)
class Setting:
    """A setting of a template: where it stands, and what it may be, a number of a range or one of some words."""

    section: str
    key: str
    value: str
    ends: tuple[float, float] | None
    words: tuple[str, ...]

    def drawn(self, dice: random.Random) -> str:
        """A value at, near or beyond an end; for a list so many of them, rising."""
        if self.ends is None:
            return dice.choice(self.words)
        count = self.value.count(",") + 1 if self.value.startswith("[") else 0
        numbers = sorted(self.number(dice) for _ in range(max(count, 1)))
        told = [str(round(each)) if self.is_whole else repr(each) for each in numbers]
        return f"[{', '.join(told)}]" if count else told[0]

    @property
    def is_whole(self) -> bool:
        """Whether it counts something."""
        return re.fullmatch(r"-?\d+", self.value) is not None

    def number(self, dice: random.Random) -> float:
        """One number."""
        low, high = self.ends or (0.0, 0.0)
        inside = dice.uniform(low, high)
        beyond = dice.choice((0.0, low / 10.0, 2.0 * low - high, high * 10.0, 2.0 * high - low))
        near = dice.choice((low, high)) + dice.choice((-1.0, 1.0)) * 1e-3 * (high - low)
        return float(dice.choices((low, high, inside, near, beyond), (4, 4, 3, 2, 1))[0])


@dataclass(frozen=True)
class Whole:
    """A command that is run as a whole: the template of its file, the smallest of these, and what is typed."""

    template: str
    base: str
    words: str


COMMANDS: Final[Mapping[str, Whole]] = {
    "tune": Whole("configuration", CLASS, "tune drawn.toml --workers 1"),
    "point-sensors": Whole("point-sensors", INPUTS["sensors.toml"], "tune drawn.toml --workers 1"),
    "sensors": Whole("configuration", INPUTS["dumper.toml"], "sensors drawn.toml --sensors 4-5 --workers 1"),
    "hardware": Whole("configuration", INPUTS["measured.toml"], "hardware drawn.toml --workers 1"),
    "sensitivity": Whole("configuration", INPUTS["measured.toml"], "sensitivity drawn.toml --points 200 --passes 100"),
    "sweep": Whole("configuration", INPUTS["sweep.toml"], "sweep run drawn.toml --workers 1"),
    "aim": Whole("aim", INPUTS["aim.toml"], "aim drawn.toml"),
    "simulate": Whole("trial", INPUTS["trial.toml"], "hump simulate drawn.toml --trains 2"),
    "capacity": Whole("trial", INPUTS["trial.toml"], "hump capacity drawn.toml --speeds 1.7,2.6 --trains 2"),
    "design": Whole("trial", INPUTS["trial.toml"], "hump design drawn.toml --speed 1.5"),
    "speed": Whole("trial", INPUTS["trial.toml"], "hump speed drawn.toml"),
    "make": Whole("short-hump", INPUTS["short.toml"], "hump make drawn.toml"),
    "computer": Whole("computer", INPUTS["computer.toml"], "computer drawn.toml"),
    "explore": Whole("configuration", INPUTS["park.toml"], "explore park/book.h5 --config drawn.toml"),
    "watch": Whole("configuration", INPUTS["park.toml"], "watch validated/log.h5 --config drawn.toml"),
    "yard": Whole("yard", INPUTS["yard.toml"], "hump watch drawn.toml"),
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Print what came of each kind of runs; 1 if there is a fault."""
    asked = parser().parse_args(arguments)
    os.environ |= SURROUNDINGS
    whole, counts, slowest_s = COMMANDS[asked.command], Counter[str](), 0.0
    typed = [*whole.words.split(), "-o", "out"]
    for number in range(-1, asked.number):
        text = drawn(whole, f"{asked.command} {asked.seed} {number}") if number >= 0 else whole.base
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for each in asked.inputs.iterdir() if asked.inputs else ():
                (folder / each.name).symlink_to(each.resolve())
            (folder / "drawn.toml").write_text(text, encoding="utf-8")
            if number < 0:
                warmed(typed, folder)
                continue
            ended = forked(typed, folder, limits=LIMITS_OF_RUN)
            faults = [*faults_of(ended, folder)]
            counts[f"exit {ended.code}"] += 1
            slowest_s = max(slowest_s, ended.seconds)
            if faults:
                counts["faults"] += 1
                kept = asked.output / f"{asked.command}-{asked.seed}-{number}"
                kept.mkdir(parents=True, exist_ok=True)
                shutil.copy(folder / "drawn.toml", kept)
                (kept / "fault.txt").write_text("\n".join(faults) + "\n")
                print(f"{kept}: {faults[0][:300]}", flush=True)
            if number % 20 == 19 or number == asked.number - 1:
                print(f"{asked.command} {number + 1}: {dict(counts)}, slowest {slowest_s:.1f} s", flush=True)
    return 1 if counts["faults"] else 0


def parser() -> argparse.ArgumentParser:
    """What may be asked for."""
    asked = argparse.ArgumentParser(prog="python -m tests.attack.legal", description=__doc__)
    asked.add_argument("command", choices=tuple(COMMANDS))
    asked.add_argument("--number", type=int, default=50, help="of configurations, after the smallest form itself")
    asked.add_argument("--seed", type=int, default=0)
    asked.add_argument("--inputs", type=Path, help="what the golden commands leave, for explore, watch and yard")
    asked.add_argument("-o", "--output", type=Path, default=Path("out/attack/legal"), help="where faults are stored")
    return asked


def settings_in(template: str) -> Iterator[Setting]:
    """Every number with limits, and every word out of some, of a template."""
    section, said = "", ""
    for line in template.splitlines():
        if found := SECTION.match(line):
            section = found[1]
        elif found := SETTING.match(line):
            told = f"; {found[3] or said}"
            ends, words = LIMITS.search(told), WORDS.search(told)
            if not EFFORT.fullmatch(found[1]) and not found[2].startswith(("[[", "{")):
                if found[2] in ("true", "false"):
                    yield Setting(section, found[1], found[2], None, ("true", "false"))
                elif ends is not None:
                    yield Setting(section, found[1], found[2], (float(ends[1]), float(ends[2])), ())
                elif words is not None and found[2].startswith('"'):
                    names = re.split(", | or ", words[1])
                    yield Setting(section, found[1], found[2], None, tuple(f'"{each}"' for each in names))
        said = line.removeprefix("# ") if line.startswith("#") else said


def drawn(whole: Whole, seed: str) -> str:
    """The smallest form with one to five settings of the template drawn."""
    dice = random.Random(seed)
    (kind,) = (each for each in FILE_KINDS if each.word == whole.template)
    every = [each for each in settings_in(kind.text("")) if each.section != "output"]
    text = whole.base
    if dice.random() < 0.8:  # pictures last longer than all else
        text = with_setting(with_setting(text, "output", "plots", "false"), "output", "report", "false")
    for setting in dice.sample(every, min(dice.choice((1, 1, 2, 2, 3, 5)), len(every))):
        text = with_setting(text, setting.section, setting.key, setting.drawn(dice))
    return text


def with_setting(text: str, section: str, key: str, value: str) -> str:
    """`text` with the key of the section set, in the last of its tables where there are several."""
    lines = text.splitlines()
    heads = [number for number, line in enumerate(lines) if SECTION.match(line) and not line.startswith("#")]
    at = [number for number in heads if lines[number].strip("[]") == section]
    if not section:
        first, last = 0, heads[0] if heads else len(lines)
    elif not at:
        return "\n".join((*lines, f"[{section}]", f"{key} = {value}", ""))
    else:
        first = at[-1] + 1
        last = min((number for number in heads if number >= first), default=len(lines))
    body = [line for line in lines[first:last] if not re.match(rf"{key}\s*=", line)]
    return "\n".join((*lines[:first], f"{key} = {value}", *body, *lines[last:], ""))


def faults_of(ended: Ended, folder: Path) -> Iterator[str]:
    """What is wrong with how a run ended, and with what it left."""
    if ended.code not in (0, 1, 2):
        yield f"it ended with {ended.code} after {ended.seconds:.0f} s: {ended.err[-LONGEST:]}"
    if "Traceback" in ended.err + ended.out or "Warning:" in ended.err:
        yield ended.err[-3 * LONGEST :]
    for line in (ended.out + ended.err).splitlines():
        if not line.replace("\x1b", "").isprintable() or (ended.code == 2 and len(line) > LONGEST):
            yield f"{len(line)} letters: {line[:LONGEST]!r}"
        elif NO_FIGURE.search(line):
            yield f"printed: {line}"
    if ended.code == 2 and not ended.err.splitlines()[-1].startswith("retarder-synth: "):
        yield f"refused without a sentence: {ended.err!r}"
    if ended.code in (0, 1):
        for name, content in contents(folder / "out").items():
            if "golden" not in name and name.endswith((".json", ".csv", ".html", ".toml", ".svg", ".xml")):
                wrong = NO_NUMBER if name.endswith(".csv") else NO_FIGURE
                found = wrong.search(without_script(content.decode()))
                if found:
                    yield f"{name} has {found[0]}: {content.decode()[max(found.start() - 80, 0) : found.end() + 40]!r}"


def without_script(text: str) -> str:
    """A page without its programs, which may say NaN."""
    return re.sub(r"<script\b.*?</script>", lambda found: " " * len(found[0]), text, flags=re.DOTALL)


if __name__ == "__main__":
    sys.exit(main())
