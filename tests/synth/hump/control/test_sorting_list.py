"""Trains as sorting lists, written and drawn.

Sorting lists: what is written reads back, and every mistake is told with row and column.
Sorting lists that nobody wrote.
Trains of a population: shares and numbers as asked, the same for the same seed.
"""

from __future__ import annotations

import csv
import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plant_models.errors import PlantError
from plant_models.library import load_car, load_weight_categories
from plant_models.rolling.car_mix import CarMix, MixedCar
from synth.frame.faults import InputError
from synth.hump.control.cut_record import CutRecord, Mark, Rolling, SortingList
from synth.hump.control.sorting_list_file import COLUMNS, load_sorting_list, sorting_list_of_csv
from synth.hump.control.train_population import TrainPopulation, chosen

CATEGORIES = load_weight_categories()
HEAD = "cut,cars,axles,mass_t,category,track\n"


@st.composite
def lists(draw: st.DrawFn) -> SortingList:
    """One to six cuts."""
    cuts = []
    for serial in range(1, draw(st.integers(1, 6)) + 1):
        cars = draw(st.integers(1, 60))
        cuts.append(
            CutRecord(
                serial=serial,
                cars=cars,
                axles=draw(st.integers(2 * cars, 400)),
                mass_t=draw(st.floats(1.0, 100.0 * cars)),
                category=draw(st.sampled_from([category.number for category in CATEGORIES.members])),
                track=draw(st.integers(1, 999)),
                length_m=draw(st.floats(4.0 * cars, 200.0 * cars)),
                rolling=draw(st.sampled_from(Rolling)),
                lead=draw(st.integers(0, 1)),
                hump_speed_m_s=draw(st.floats(0.1, 4.0)),
                marks=draw(st.frozensets(st.sampled_from(Mark))),
            )
        )
    return SortingList(tuple(cuts))


def to_sorting_csv(cuts: SortingList) -> str:
    """The text of a file with this list."""
    names = {category.number: category.latin for category in CATEGORIES.members}
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow(COLUMNS)
    for cut in cuts.cuts:
        marks = " ".join(sorted(mark.value for mark in cut.marks))
        numbers = [cut.serial, cut.cars, cut.axles, repr(cut.mass_t), names[cut.category], cut.track]
        writer.writerow(
            [*numbers, repr(cut.length_m), cut.rolling.name.lower(), cut.lead, repr(cut.hump_speed_m_s), marks]
        )
    return text.getvalue()


@given(lists())
def test_what_is_written_reads_back(cuts: SortingList) -> None:
    assert sorting_list_of_csv(to_sorting_csv(cuts), "train.csv", CATEGORIES) == cuts


def test_the_columns_that_must_be_there_are_enough() -> None:
    (cut,) = sorting_list_of_csv(HEAD + "7,2,8,151.5,T,17\n", "train.csv", CATEGORIES).cuts
    assert cut == CutRecord(7, 2, 8, 151.5, 5, 17, 2 * 13.92)


def test_a_spreadsheet_may_write_semicolons_and_decimal_commas_and_leave_the_category_out() -> None:
    plain = sorting_list_of_csv(HEAD + "1,2,8,151.5,T,17\n2,1,4,23,L,3\n", "train.csv", CATEGORIES)
    for separator in (";", "\t"):
        rows = ("cut,cars,axles,mass_t,track", "1,2,8,151/5,17", "2,1,4,23,3", ",,,,")
        text = "\ufeff" + "\r\n".join(row.replace(",", separator).replace("/", ",") for row in rows)
        assert sorting_list_of_csv(text, "train.csv", CATEGORIES) == plain


def test_columns_may_stand_in_any_order_and_names_of_categories_be_latin_or_cyrillic() -> None:
    text = (
        "\ufeffmarks,track,category,mass_t,axles,cars,cut\r\ndo-not-hump long-base,3,ЛС,40,4,1,1\r\n,4,LS,40,4,1,2\r\n"
    )
    refused, humped = sorting_list_of_csv(text, "train.csv", CATEGORIES).cuts
    assert refused.marks == {Mark.DO_NOT_HUMP, Mark.LONG_BASE}
    assert (refused.category, humped.category) == (2, 2)
    assert SortingList((refused, humped)).humped == (humped,)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "train.csv: it is empty; its first row must name the columns cut, cars, axles, mass_t, track"),
        ("cut,wheels\n", "train.csv: row 1: column 'wheels' is unknown; known: "),
        ("cut,cut\n", "train.csv: row 1: column cut is there twice; leave one out"),
        ("cut,cars,axles,mass_t,category\n", "train.csv: row 1: column track is missing; add it"),
        (HEAD, "train.csv: sorting list: it holds no cut"),
        (HEAD + "1,1,4,60,T\n", "train.csv: row 2: 5 cells; the first row has 6 columns"),
        (HEAD + "1,1,4,60,T,3\n2,one,4,60,T,3\n", "train.csv: row 3: cars is 'one'; it must be a whole number"),
        (HEAD + "1,1,4,60 t,T,3\n", "train.csv: row 2: mass_t is '60 t'; it must be a number, with a decimal point"),
        (HEAD + "1,1,4,1_0,T,3\n", "train.csv: row 2: mass_t is '1_0'"),
        (HEAD + "1,1,4,nan,T,3\n", "train.csv: row 2: mass_t is nan; it must be a finite number from 1 to 200"),
        (HEAD + "1,1,4,60,X,3\n", "train.csv: row 2: category: weight category 'X' is not in the library; "),
        (HEAD + "1,1,4,60,T,\n", "train.csv: row 2: track is ''; it must be a whole number"),
        (HEAD + "1,1,4,60,T,0\n", "train.csv: row 2: track is 0; it must be a whole number 1 to 999"),
        (HEAD + "1,1,4,60,T,٣\n", "train.csv: row 2: track is '٣'; it must be a whole number"),
        (HEAD + "2,1,4,60,T,3\n2,1,4,60,T,3\n", "train.csv: sorting list: cut 2 stands behind cut 2; the numbers must"),
        (HEAD.replace("\n", ",marks\n") + "1,1,4,60,T,3,fast\n", "train.csv: row 2: marks: 'fast' is no mark; known: "),
        (
            HEAD.replace("\n", ",rolling\n") + "1,1,4,60,T,3,so\n",
            "train.csv: row 2: rolling is 'so'; it must be one of",
        ),
        (HEAD + '1,1,4,60,T,"3\n', "train.csv: this is not valid CSV ("),
    ],
)
def test_a_mistake_is_told_with_row_and_column(text: str, sentence: str) -> None:
    with pytest.raises(InputError) as told:
        sorting_list_of_csv(text, "train.csv", CATEGORIES)
    assert str(told.value).startswith(sentence)
    assert "\n" not in str(told.value)


def test_every_row_at_fault_is_told() -> None:
    with pytest.raises(InputError) as told:
        sorting_list_of_csv(HEAD + "1,0,4,60,T,3\n2,1,4,60,T,3\n3,1,4,60,T,x\n", "train.csv", CATEGORIES)
    assert [sentence.split(":")[1] for sentence in told.value.sentences] == [" row 2", " row 4"]


def sentences(text: str) -> tuple[str, ...]:
    """What is told about a list; nothing where it is one."""
    try:
        sorting_list_of_csv(text, "train.csv", CATEGORIES)
    except InputError as fault:
        return fault.sentences
    return ()


def test_a_file_that_is_none_is_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no such file"):
        load_sorting_list(tmp_path / "none.csv")
    (tmp_path / "latin.csv").write_bytes(b"cut\xff")
    with pytest.raises(InputError, match="byte 3 is not UTF-8"):
        load_sorting_list(tmp_path / "latin.csv")
    with pytest.raises(InputError, match="cannot be read"):
        load_sorting_list(tmp_path)
    (tmp_path / "train.csv").write_text(HEAD + "1,1,4,60,T,3\n", encoding="utf-8")
    assert len(load_sorting_list(tmp_path / "train.csv")) == 1


def drawn_list(population: TrainPopulation, seed: int, cuts: int) -> SortingList:
    """Train 0 of the row `seed` as a list."""
    drawn = population.drawn(seed, 0, 1, cuts)
    real = drawn.mass_t > 0.0
    axles = np.where(real, population.mix.axles[drawn.types], 0).sum(axis=1)
    lengths = np.where(real, np.array([each.car.length_m for each in population.mix.cars])[drawn.types], 0.0)
    return SortingList(
        tuple(
            CutRecord(
                serial=row + 1,
                cars=int(drawn.cars[row]),
                axles=int(axles[row]),
                mass_t=round(float(drawn.mass_t[row].sum()), 3),
                category=population.categories.members[drawn.category[row]].number,
                track=int(drawn.track[row]),
                length_m=round(float(lengths[row].sum()), 3),
            )
            for row in range(cuts)
        )
    )


MIX = CarMix(tuple(MixedCar(load_car(name).car, share, 10.0) for name, share in (("gondola-4", 0.7), ("tank-4", 0.3))))
POPULATION = TrainPopulation(MIX, CATEGORIES, {1: 0.4, 3: 0.2, 5: 0.4}, dict.fromkeys(range(1, 33), 1.0))
MANY = 999


def test_cuts_have_a_geometric_number_of_cars() -> None:
    """P(n) = q·(1 − q)^(n − 1) with q = 1/2, of 10 × 999 cuts; χ² with five classes below its 99.9 % quantile."""
    cars = np.array([cut.cars for seed in range(10) for cut in drawn_list(POPULATION, seed, MANY).cuts])
    counts = np.array([*(np.sum(cars == n) for n in range(1, 5)), np.sum(cars >= 5)])
    expected = len(cars) * np.array([1 / 2, 1 / 4, 1 / 8, 1 / 16, 1 / 16])
    assert float(np.sum((counts - expected) ** 2 / expected)) < 18.5
    assert {cut.cars for cut in drawn_list(replace(POPULATION, cars_mean=1.0), 1, 200).cuts} == {1}
    assert max(cut.cars for cut in drawn_list(replace(POPULATION, cars_mean=8.0, most_cars=9), 1, MANY).cuts) == 9


def test_categories_and_tracks_have_their_shares() -> None:
    """Within four standard deviations."""
    cuts = [cut for seed in range(10) for cut in drawn_list(POPULATION, seed, MANY).cuts]
    for number, share in {1: 0.4, 2: 0.0, 3: 0.2, 4: 0.0, 5: 0.4}.items():
        found = sum(cut.category == number for cut in cuts) / len(cuts)
        assert abs(found - share) <= 4.0 * (share * (1.0 - share) / len(cuts)) ** 0.5
    tracks = [sum(cut.track == track for cut in cuts) for track in range(1, 33)]
    assert sum(tracks) == len(cuts)
    assert max(abs(count - len(cuts) / 32) for count in tracks) < 4.5 * (len(cuts) / 32) ** 0.5


def test_every_cut_is_of_its_category() -> None:
    """Axle loads of its cars, so of the cut too, lie between the limits of the category."""
    limits = [category.mass_above_t for category in CATEGORIES.members]
    for cut in drawn_list(POPULATION, 3, MANY).cuts:
        place = next(n for n, category in enumerate(CATEGORIES.members) if category.number == cut.category)
        per_car = cut.mass_t / cut.axles * 4.0
        assert limits[place] <= per_car + 1e-3
        assert place + 1 == len(limits) or per_car <= limits[place + 1] + 1e-3
        assert cut.axles == 4 * cut.cars


def test_a_seed_is_a_train_and_a_longer_train_begins_with_the_shorter() -> None:
    train = drawn_list(POPULATION, 5, 40)
    assert train == drawn_list(POPULATION, 5, 40)
    assert drawn_list(POPULATION, 5, 60).cuts[:40] == train.cuts
    assert drawn_list(POPULATION, 6, 40) != train


def test_a_share_of_none_is_never_chosen() -> None:
    shares = {1: 0.0, 2: 1.0, 3: 0.0, 4: 1.0, 5: 0.0}
    u = np.array([2.0**-53, 0.25, 0.5, 0.75, 1.0 - 2.0**-53])
    assert set(chosen(shares, u).tolist()) == {2, 4}
    assert set(chosen(shares, u, np.full(5, 2)).tolist()) == {4}
    assert set(chosen(shares, u, np.full(5, 4)).tolist()) == {2}


def test_cuts_that_follow_each_other_go_to_different_tracks() -> None:
    """By the shares of the others: behind track 1, track 2 has 0.3 of 0.5 (four standard deviations)."""
    some = replace(POPULATION, track_shares={1: 0.5, 2: 0.3, 3: 0.2})
    drawn = some.drawn(3, 0, 100, 40).track.reshape(100, 40)
    ahead, behind = drawn[:, :-1].ravel(), drawn[:, 1:].ravel()
    assert not np.any(ahead == behind)
    after = behind[ahead == 1]
    assert abs(np.mean(after == 2) - 0.6) < 4.0 * (0.24 / len(after)) ** 0.5
    first = some.drawn(3, 0, 4000, 1).track
    assert abs(np.mean(first == 1) - 0.5) < 4.0 * (0.25 / 4000) ** 0.5
    assert {cut.track for cut in drawn_list(replace(POPULATION, track_shares={7: 1.0, 8: 0.0}), 1, 20).cuts} == {7}


def test_a_train_is_the_same_whatever_is_drawn_beside_it() -> None:
    whole, part = POPULATION.drawn(5, 0, 60, 40), POPULATION.drawn(5, 23, 31, 40)
    for name in ("cars", "category", "track", "types", "mass_t"):
        np.testing.assert_array_equal(getattr(part, name), getattr(whole, name)[23 * 40 : 54 * 40], err_msg=name)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"cars_mean": 0.5}, "cars_mean"),
        ({"most_cars": 0}, "most_cars"),
        ({"track_shares": {}}, "track_shares has no share above 0"),
        ({"track_shares": {1: -1.0}}, "track_shares of 1"),
        ({"category_shares": {9: 1.0}}, "category_shares names 9"),
    ],
)
def test_what_no_population_can_be_is_refused(change: dict[str, object], words: str) -> None:
    with pytest.raises(PlantError, match=words):
        replace(POPULATION, **change)  # type: ignore[arg-type]  # wrong on purpose


def test_a_train_has_1_to_999_cuts() -> None:
    for cuts in (0, 1000):
        with pytest.raises(PlantError, match="must have 1 to 999"):
            drawn_list(POPULATION, 1, cuts)
