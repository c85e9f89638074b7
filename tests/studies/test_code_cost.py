"""What compiled code costs: listings and dumps whose numbers are known, and a program whose instructions are."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from scripts.studies.in_the_loop.code_cost import (
    CodeSize,
    dearest_call,
    missing,
    size_in,
    size_program,
    totals_in,
)

LISTING = """\
retarder_table.o  :
section                    size   addr
.text                       100      0
.text.unlikely               10      0
.data                         4      0
.bss                          2      0
.rodata                    1000      0
.data.rel.ro.local          200      0
.comment                     55      0
Total                      1371
"""


def test_sections_are_summed_by_kind_and_remarks_are_none() -> None:
    assert size_in(LISTING) == CodeSize(code=110, constants=1200, variables=6)


def test_a_cross_compiler_has_a_size_program_of_its_own() -> None:
    assert size_program("gcc") == "size"
    assert size_program("arm-linux-gnueabihf-gcc") == "arm-linux-gnueabihf-size"


def test_a_dump_tells_its_total() -> None:
    assert totals_in("events: Ir\n0 12\n\ntotals: 12\n") == [12]
    assert totals_in("nothing\n") == []


PROGRAM = """\
#include <unistd.h>
__attribute__((noinline)) unsigned work(unsigned turns) {
    unsigned sum = 0;
    for (volatile unsigned i = 0; i < turns; i++) sum += i;
    return sum;
}
int main(void) {
    unsigned char turns;
    unsigned sum = 0;
    while (read(0, &turns, 1) == 1) sum += work(turns);
    return sum == 1;
}
"""


@pytest.mark.skipif(bool(missing("gcc", "valgrind")), reason="gcc and valgrind are not installed")
def test_the_dearest_call_is_the_one_that_turns_most(tmp_path: Path) -> None:
    """A loop's instructions grow in proportion with its turns, whatever the order of the calls."""
    source, program = tmp_path / "work.c", tmp_path / "work"
    source.write_text(PROGRAM)
    subprocess.run(["gcc", "-O1", str(source), "-o", str(program)], check=True)

    def cost(*turns: int) -> int:
        return dearest_call((str(program),), "work", bytes(turns), tmp_path)

    ten, twenty = cost(10), cost(20)
    a_turn = (twenty - ten) / 10
    assert 3 <= a_turn <= 10
    assert cost(10, 20, 1) == twenty
    assert cost(30) == twenty + 10 * a_turn
