"""By hand: `python -m tests.synth.hump.control.many_trains FIRST LAST` humps the trains of these seeds and counts."""

from __future__ import annotations

import sys
from collections import Counter

from tests.synth.hump.control.judged_trains import Scene, judgement, random_humping

SCENES = {
    "no fault": Scene(),
    "points": Scene(faults=3, points_alone=True),
    "uncoupling": Scene(wrong_share=0.15),
    "sensors and points": Scene(faults=3),
    "all": Scene(faults=3, wrong_share=0.1),
    "stalled": Scene(stalled_share=0.1),
    "stalled, points": Scene(faults=3, points_alone=True, stalled_share=0.1),
    "stalled, all": Scene(faults=3, wrong_share=0.1, stalled_share=0.1),
    "published model, points": Scene(faults=3, points_alone=True, published=True),
    "stalled, published model, points": Scene(faults=3, points_alone=True, stalled_share=0.1, published=True),
}


def main(first: int, last: int) -> None:
    """Print the counts of every scene; the seeds go round among them."""
    for place, (name, scene) in enumerate(SCENES.items()):
        counts: Counter[str] = Counter()
        for seed in range(first + place, last, len(SCENES)):
            counts.update(judgement(random_humping(seed, scene)))
        print(f"{name}: {dict(counts)}", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
