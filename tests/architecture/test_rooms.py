"""The architecture page shows the rooms as they stand."""

from __future__ import annotations

from pathlib import Path

import networkx as nx

from scripts.studies.documents import result_of
from scripts.studies.rooms import METHOD, Options, floors_of, purpose_of
from scripts.studies.study import silent

ROOT = Path(__file__).parents[2]


def test_the_kept_rooms_are_those_of_the_code() -> None:
    assert result_of(ROOT, "rooms").findings == METHOD.run(Options(), silent), (
        "run 'retarder-synth study rooms --document'"
    )


def test_a_room_stands_as_low_as_it_can_and_the_lowest_below_those_who_know_them() -> None:
    graph = nx.DiGraph([("top", "middle"), ("middle", "low"), ("top", "checker"), ("low", "ground")])
    assert floors_of(graph) == {"top": 3, "middle": 2, "checker": 2, "low": 1, "ground": 0}


def test_a_purpose_is_the_first_sentence_of_the_docstring() -> None:
    assert purpose_of("kernels") == "The inner loops, compiled."
