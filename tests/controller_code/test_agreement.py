"""Compiled C decides as the Python rule does, for every compiler, level and processor there is."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from synth.in_the_loop.controller_process import BuildError, Controller, build_controller
from tests.controller_code.conftest import Tool
from tests.controller_code.hard_inputs import hard_commands, hard_readings
from tuning_tables import decide_for, decide_many
from tuning_tables.table_block import block_of
from tuning_tables.table_book import Status, TableBook

READINGS, COMMANDS = 1_000_000, 20_000
FREELY = ("-Wall", "-Wextra", "-Werror")
"""Without -std=c99: the compiler may then fuse multiplication and addition."""


@dataclass(frozen=True)
class Build:
    """One way of compiling."""

    compiler: str
    flags: tuple[str, ...]
    options: dict[str, object] = field(default_factory=dict)
    needs: tuple[str, ...] = ()

    def __str__(self) -> str:
        return " ".join((self.compiler, *self.flags))

    def made(self, book: TableBook, directory: Path, tool: Tool) -> Controller:
        """The controller compiled in this way."""
        for name in (self.compiler, *self.needs):
            tool(name)
        return build_controller(book, directory, self.compiler, self.flags, **self.options)  # type: ignore[arg-type]


SANITIZED = ("-g", "-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-fno-omit-frame-pointer")
STATIC = {"link": ("-static",)}
BUILDS = [
    *(Build(compiler, (f"-O{level}",)) for compiler in ("gcc", "clang") for level in range(4)),
    *(Build(compiler, ("-O3", "-mfma", "-ffp-contract=fast"), {"contract": FREELY}) for compiler in ("gcc", "clang")),
    Build("gcc", ("-O2", "-mfpmath=387"), {"contract": FREELY}),
    *(Build(compiler, SANITIZED) for compiler in ("gcc", "clang")),
    *(
        Build("arm-linux-gnueabihf-gcc", flags, {**STATIC, "runner": ("qemu-arm",)}, ("qemu-arm",))
        for flags in (("-O0",), ("-O2", "-mthumb"), ("-O3", "-marm", "-mfpu=vfpv4", "-ffp-contract=fast"))
    ),
    Build("powerpc-linux-gnu-gcc", ("-O2",), {**STATIC, "runner": ("qemu-ppc",), "order": ">"}, ("qemu-ppc",)),
]


@pytest.fixture(scope="session")
def readings(book: TableBook) -> NDArray[np.void]:
    return hard_readings(book, READINGS, 20261121)


@pytest.fixture(scope="session")
def answers(book: TableBook, readings: NDArray[np.void]) -> NDArray[np.int8]:
    """The answers of the Python rule, table by table."""
    found = np.empty(len(readings), np.int8)
    for number, table in enumerate(book.tables):
        of_table = readings["table"] == number
        asked = readings[of_table]
        found[of_table] = decide_many(table, asked["stage"], asked["s_m"], asked["v_m_s"])
    return found


@pytest.mark.slow
@pytest.mark.parametrize("build", BUILDS, ids=str)
def test_c_decides_and_chooses_as_python(
    build: Build, book: TableBook, readings: NDArray[np.void], answers: NDArray[np.int8], tmp_path: Path, tool: Tool
) -> None:
    controller = build.made(book, tmp_path, tool)
    assert controller.self_test() == "fault 0 at 0"
    assert np.array_equal(controller.dump(), [block_of(book, n).words for n in range(len(book.tables))])
    assert np.count_nonzero(controller.decide(readings) != answers) == 0
    commands = hard_commands(book, COMMANDS, 7)
    statuses, words = controller.select(commands)
    expected_statuses, expected_words = choices(book, commands)
    assert np.array_equal(statuses, expected_statuses)
    assert np.array_equal(words, expected_words)


def test_the_readings_reach_every_answer_and_many_ties(
    book: TableBook, readings: NDArray[np.void], answers: NDArray[np.int8]
) -> None:
    assert len(readings) == READINGS
    assert np.count_nonzero(np.isnan(readings["v_m_s"])) > 1000
    assert np.count_nonzero(np.isinf(readings["s_m"])) > 1000
    tiny = np.finfo(np.float32).smallest_normal
    assert np.count_nonzero((readings["v_m_s"] != 0) & (np.abs(readings["v_m_s"]) < tiny)) > 1000
    assert all(np.count_nonzero(answers == answer) > 50_000 for answer in (-1, 0, 1))
    with np.errstate(over="ignore", invalid="ignore"):
        above = np.nextafter(readings["v_m_s"], np.float32(np.inf))
    ties = 0
    for number, table in enumerate(book.tables):
        asked = readings["table"] == number
        now = readings[asked]
        ties += np.count_nonzero(decide_many(table, now["stage"], now["s_m"], above[asked]) != answers[asked])
    assert ties > 50_000  # one step of float32 changes the answer


def test_one_reading_at_a_time_is_decided_as_many(
    book: TableBook, readings: NDArray[np.void], answers: NDArray[np.int8]
) -> None:
    for place in np.random.default_rng(5).integers(0, len(readings), 5000):
        table, stage, s, v = readings[place]
        assert decide_for(book.tables[table], int(stage), s, v) == answers[place]


@pytest.mark.parametrize("flag", ["-ffast-math", "-ffinite-math-only"])
@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_switches_that_break_the_rule_are_refused(
    compiler: str, flag: str, book: TableBook, tmp_path: Path, tool: Tool
) -> None:
    with pytest.raises(BuildError, match="compile without -ffast-math"):
        build_controller(book, tmp_path, tool(compiler), (flag,))


def choices(book: TableBook, commands: NDArray[np.void]) -> tuple[NDArray[np.int32], NDArray[np.uint32]]:
    """What `TableBook.choose` answers, as the controller writes it."""
    words = np.zeros((len(commands), len(block_of(book, 0).words)), np.uint32)
    statuses = np.empty(len(commands), np.int32)
    for place, (category, axles, speed) in enumerate(commands.tolist()):
        known = 1 <= category <= len(book.categories)
        name = book.categories[category - 1] if known else "unknown"
        choice = book.choose(name, axles, speed)
        statuses[place] = choice.status
        if choice.table is not None:
            words[place] = block_of(book, choice.numbers[0], choice.table).words
    seen = set(statuses.tolist())
    assert seen == {int(status) for status in Status}
    return statuses, words
