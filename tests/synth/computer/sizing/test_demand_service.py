"""Mean waits on demand: known figures, limits, laws of conservation, growth with the load."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from plant_models.errors import PlantError
from synth.computer.sizing.demand_service import (
    Discipline,
    MeanWait,
    mean_waits,
    residual,
)
from synth.computer.sizing.service_law import (
    Constant,
    Erlang,
    Exponential,
    Hyperexponential,
)
from synth.computer.sizing.task import Stream, Task, TaskMix, total_load
from tests.synth.computer.sizing.mixes import EXPONENTIAL, MIXED

LAWS = st.one_of(
    st.builds(Constant, st.floats(0.01, 1.0)),
    st.builds(Exponential, st.floats(0.01, 1.0)),
    st.builds(Erlang, st.floats(0.01, 1.0), st.integers(1, 9)),
    st.builds(Hyperexponential, st.floats(0.01, 1.0), st.floats(1.1, 20.0)),
)


@st.composite
def mixes(draw: st.DrawFn) -> tuple[Stream, ...]:
    """One to five streams with a load below 1 in all, some of equal priority."""
    laws = draw(st.lists(LAWS, min_size=1, max_size=5))
    shares = [draw(st.floats(0.01, 0.19)) for _ in laws]
    priorities = [draw(st.integers(1, 3)) for _ in laws]
    return tuple(
        Stream(str(i), share / law.mean, law, priority)
        for i, (law, share, priority) in enumerate(zip(laws, shares, priorities, strict=True))
    )


def test_the_figures_of_the_published_check() -> None:
    relative = mean_waits(EXPONENTIAL, Discipline.RELATIVE)
    absolute = mean_waits(EXPONENTIAL, Discipline.ABSOLUTE)
    assert [wait.start_s for wait in relative] == pytest.approx([0.549, 0.901, 1.867], abs=5e-4)
    assert [wait.sojourn_s for wait in absolute] == pytest.approx([0.588, 1.456, 3.507], abs=5e-4)


def conserved_work(streams: tuple[Stream, ...], waits: tuple[MeanWait, ...]) -> float:
    """Σ ρ_i W_i, s: the same for every order of service that neither idles nor interrupts, ρ W₀/(1 − ρ)."""
    return math.fsum(stream.load * wait.start_s for stream, wait in zip(streams, waits, strict=True))


@given(mixes())
def test_order_of_service_conserves_work(streams: tuple[Stream, ...]) -> None:
    # Kleinrock: any laws, any priorities; nobody is interrupted
    load = total_load(streams)
    right = load * residual(streams) / (1.0 - load)
    for discipline in (Discipline.FIRST_COME, Discipline.RELATIVE):
        assert conserved_work(streams, mean_waits(streams, discipline)) == pytest.approx(right, rel=1e-12)


def test_the_answers_keep_the_order_of_the_streams() -> None:
    for discipline in Discipline:
        assert [wait.task for wait in mean_waits(MIXED, discipline)] == [stream.name for stream in MIXED]


@pytest.mark.parametrize(("rate", "words"), [(2.0, "0 % more"), (2.5, "25 % more"), (20.0, "900 % more")])
def test_an_overloaded_computer_says_by_how_much(rate: float, words: str) -> None:
    streams = TaskMix((Task("all", rate, Constant(50.0)),)).streams(100.0)
    for discipline in Discipline:
        with pytest.raises(PlantError, match=words):
            mean_waits(streams, discipline)


def test_a_name_is_not_given_twice() -> None:
    task = Task("a", 1.0, Constant(1.0))
    with pytest.raises(PlantError, match="a is given twice"):
        TaskMix((task, task))
