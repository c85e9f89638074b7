"""All checks of a qualification, made one after the other in a folder that is removed."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from synth.cli.qualification.any_time import any_time_checks
from synth.cli.qualification.c_code import c_checks
from synth.cli.qualification.check import Check, Outcome
from synth.cli.qualification.golden import golden_checks
from synth.cli.qualification.installed import (
    Installed,
    defect_check,
    libraries,
    library_check,
    own_content,
    program_check,
)
from synth.cli.qualification.kernels import plain_checks, tune_checks
from synth.cli.qualification.second_program import loop_check, planted_checks, prediction_check, verify_check
from synth.cli.qualification.structured_text import st_checks
from synth.cli.qualification.tuned import ESTIMATED, MEASURED, tuned_twice
from synth.frame.known_defects import known_defects

STEPS: Final = 6


@dataclass(frozen=True)
class Qualified:
    """The checks in their order, the program and its libraries, and the files of the two books by name."""

    checks: tuple[Check, ...]
    packages: tuple[Installed, ...]
    files: Mapping[str, bytes]

    def having(self, outcome: Outcome) -> tuple[Check, ...]:
        """The checks that come to `outcome`."""
        return tuple(check for check in self.checks if check.outcome is outcome)


def qualified(done: Callable[[str], None]) -> Qualified:
    """Make all checks; `done` is told each of the STEPS."""
    checks: list[Check] = []

    def add(step: str, found: Iterable[Check]) -> None:
        checks.extend(found)
        done(step)

    found = libraries()
    add("files", (program_check(), library_check(found), defect_check(known_defects())))
    with tempfile.TemporaryDirectory(prefix="retarder-synth-") as folder, ThreadPoolExecutor(2) as pool:
        usual, plain = tuned_twice(Path(folder))
        books = {book.kind: book for book in usual}
        add("kernels", (*tune_checks(usual), *golden_checks(usual), *plain_checks(usual, plain)))
        measured, estimated = books[MEASURED], books[ESTIMATED]
        add("second simulator", (prediction_check(measured), *pool.map(loop_check, usual)))
        at_any_time = pool.submit(lambda: tuple(any_time_checks(measured)))
        add("second program", (*pool.map(verify_check, usual), *planted_checks(estimated), *at_any_time.result()))
        add("C code", c_checks(estimated))
        add("Structured Text", st_checks(estimated))
    files = {f"{book.kind}/{name}": content for book in usual for name, content in book.content.items()}
    return Qualified(tuple(checks), (own_content(), *found), files)
