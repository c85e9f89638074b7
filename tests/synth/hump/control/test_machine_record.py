"""The word of 53 bits: every field at both ends, refused beyond, no bit lost and none shared."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from plant_models.errors import PlantError
from synth.hump.control.cut_record import (
    SHIFTS,
    WIDTHS,
    WORD_BITS,
    CutRecord,
    MachineRecord,
    Rolling,
    destination_code,
    limits,
    machine_record,
    record_of_word,
)

LEAST = MachineRecord(**{field: limits(field)[0] for field in WIDTHS})
RECORDS = st.builds(MachineRecord, **{field: st.integers(*limits(field)) for field in WIDTHS})


@pytest.mark.requirement("HUMP-07")
def test_the_fields_of_s0_make_53_bits() -> None:
    assert sum(WIDTHS.values()) == WORD_BITS == 53
    covered = [shift + bit for field, shift in SHIFTS.items() for bit in range(WIDTHS[field])]
    assert sorted(covered) == list(range(53))


@pytest.mark.requirement("HUMP-07")
@given(RECORDS)
def test_a_word_gives_its_record_back(record: MachineRecord) -> None:
    assert 0 <= record.word < 2**53
    assert record_of_word(record.word) == record


@given(st.integers(0, 2**53 - 1))
def test_a_record_gives_its_word_back(word: int) -> None:
    if word >> SHIFTS["rolling_code"] & 15 == 15:
        with pytest.raises(PlantError, match="rolling_code is 15"):
            record_of_word(word)
    else:
        assert record_of_word(word).word == word


@pytest.mark.parametrize("field", WIDTHS)
def test_a_field_holds_both_its_ends_and_refuses_what_is_beyond(field: str) -> None:
    low, high = limits(field)
    for value in (low, high):
        record = replace(LEAST, **{field: value})
        assert getattr(record_of_word(record.word), field) == value
    for beyond in (low - 1, high + 1):
        with pytest.raises(PlantError, match=f"{field} is {beyond}; it must be a whole number {low} to {high}"):
            replace(LEAST, **{field: beyond})


@pytest.mark.parametrize("word", [-1, 2**53, 1.0, True])
def test_what_is_no_word_is_refused(word: int) -> None:
    with pytest.raises(PlantError, match="word of a cut"):
        record_of_word(word)


def test_a_word_written_out_by_hand() -> None:
    """Cut 3, 152 t, 28 m, 4 pairs, 2 cars, category 5 rolling mean, route 0 1 1, 1.7 m/s, lead 1."""
    record = CutRecord(3, 2, 8, 152.0, 5, 17, 28.0, Rolling.MEAN, 1, 1.7)
    parts = ("000010", "0001001100", "00001110", "0000011", "000001", "1101", "011000", "01100", "1")
    made = machine_record(record, (0, 1, 1))
    assert made.word == int("".join(parts), 2)
    assert (made.category, made.rolling) == (5, Rolling.MEAN)
    assert [made.position(rank) for rank in range(3)] == [0, 1, 1]


@given(
    st.integers(1, 64),
    st.integers(1, 20),
    st.floats(5.0, 2046.0),
    st.integers(1, 5),
    st.sampled_from(Rolling),
    st.floats(0.5, 3.6),
)
def test_rounding_is_at_most_half_a_step(
    serial: int, cars: int, mass_t: float, category: int, rolling: Rolling, speed_m_s: float
) -> None:
    axles = max(4 * cars, 2 * -(-int(mass_t / 50.0 + 1) // 2))
    cut = CutRecord(serial, cars, axles, mass_t, category, 1, 14.3 * cars, rolling, 0, speed_m_s)
    made = machine_record(cut, ())
    assert abs(2 * made.mass_2t - mass_t) <= 1.0
    assert abs(2 * made.length_2m - cut.length_m) <= 1.0
    assert abs(made.hump_speed_dm_s / 10.0 - speed_m_s) <= 0.05 + 1e-12
    assert (made.axle_pairs * 2, made.cars, made.category, made.rolling) == (axles, cars, category, rolling)


@pytest.mark.requirement("HUMP-07")
@pytest.mark.parametrize(
    ("cut", "words"),
    [
        (CutRecord(65, 1, 4, 60.0, 1, 1, 13.9), "serial is 65"),
        (CutRecord(1, 60, 240, 2048.0, 1, 1, 508.0), "mass_2t is 1024"),
        (CutRecord(1, 60, 240, 2000.0, 1, 1, 511.5), "length_2m is 256"),
        (CutRecord(1, 60, 258, 2000.0, 1, 1, 500.0), "axle_pairs is 129"),
        (CutRecord(1, 1, 4, 60.0, 6, 1, 13.9), "rolling_code is 16"),
        (CutRecord(1, 1, 4, 60.0, 1, 1, 13.9, hump_speed_m_s=0.4), "hump_speed_dm_s is 4"),
        (CutRecord(1, 1, 4, 60.0, 1, 1, 13.9, hump_speed_m_s=3.7), "hump_speed_dm_s is 37"),
        (CutRecord(1, 1, 3, 60.0, 1, 1, 13.9), "3 axles"),
    ],
)
def test_what_the_word_cannot_hold_is_refused_and_not_cut_off(cut: CutRecord, words: str) -> None:
    with pytest.raises(PlantError, match=words):
        machine_record(cut, ())


def test_codes_of_a_tree_are_all_different() -> None:
    """Routes of one to six switches, none the beginning of another."""
    routes = [(0,), (1, 0), (1, 1, 0), (1, 1, 1, 0, 0, 0), (1, 1, 1, 0, 0, 1), (1, 1, 1, 1)]
    assert len({destination_code(route) for route in routes}) == len(routes)
    assert destination_code((1,)) == 0b100000
    with pytest.raises(PlantError, match="7 switches"):
        destination_code((0,) * 7)
    with pytest.raises(PlantError, match="each must be 0"):
        destination_code((2,))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"serial": 0}, "cut is 0"),
        ({"cars": 0}, "cars is 0"),
        ({"cars": True}, "cars is True"),
        ({"axles": 1}, "axles is 1"),
        ({"mass_t": float("nan")}, "mass_t is nan"),
        ({"mass_t": 201.0}, "mass_t is 201"),
        ({"track": 0}, "track is 0"),
        ({"length_m": 3.0}, "length_m is 3"),
        ({"lead": 2}, "lead is 2"),
        ({"hump_speed_m_s": 4.5}, "hump_speed_m_s is 4.5"),
    ],
)
def test_what_no_cut_can_be_is_refused(change: dict[str, object], words: str) -> None:
    with pytest.raises(PlantError, match=words):
        replace(CutRecord(1, 1, 4, 60.0, 1, 1, 13.9), **change)  # type: ignore[arg-type]  # wrong on purpose
