"""Lines between two targets are taken only of tables that differ in nothing but target and lines: Python and C."""

from __future__ import annotations

import numpy as np

from scripts.studies.in_the_loop.agreement import choices_of
from scripts.studies.in_the_loop.controller_process import COMMAND
from scripts.studies.in_the_loop.held_words import held_record, held_words, places
from tests.controller_code.conftest import Built
from tests.controller_code.unlike_pairs import BETWEEN_M_S, CASES, LIGHT, LIKE, UNLIKE, axles_of, pairs
from tuning_tables import Status


def test_python_takes_lines_between_like_tables_only() -> None:
    found = {name: pairs().choose("Л", axles_of(name), BETWEEN_M_S).status for name in CASES}
    assert found == dict.fromkeys(LIKE, Status.BETWEEN) | dict.fromkeys(UNLIKE, Status.SLOWER)


def test_c_does_in_every_case(built: Built) -> None:
    controller = built(pairs())
    commands = np.array([(LIGHT, axles_of(name), BETWEEN_M_S) for name in CASES], COMMAND)
    found, words = controller.select(commands)
    own, own_words = choices_of(pairs(), commands)
    assert np.array_equal(found, own)
    assert np.array_equal(words, own_words)
    assert controller.self_test() == "fault 0 at 0"


def test_the_pairs_are_what_they_say() -> None:
    """A member that may not differ does so in some pair, and in those that are alike none does."""
    record, where, book = held_record(pairs()), places(pairs()), pairs()
    own = {name for name, each in record.members.items() if each.is_own}
    seen = set()
    for place, name in enumerate(CASES):
        one, other = (held_words(book, 2 * place + index) for index in (0, 1))
        apart = {member for member, words in where.items() if (one[words] != other[words]).any()} - own
        assert name in UNLIKE or not apart
        seen |= apart
    assert seen == {*record.members} - own - {"category", "axles", "mass_t"}
