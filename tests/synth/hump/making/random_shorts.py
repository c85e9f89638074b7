"""Random short hump files: most can be made, some break one rule or another."""

from __future__ import annotations

import random
from dataclasses import dataclass, field

TYPES = ("knp-5-bunch", "rnz-2m-park", "t-50-bunch", "vzpg-5-bunch", "kv-3-bunch")
SPARE = {
    "throw_s": (0.3, 1.2),
    "section_ahead_m": (0.0, 9.0),
    "section_behind_m": (0.1, 9.0),
    "turn_deg": (0.0, 8.0),
    "fouling_m": (10.0, 60.0),
}


@dataclass
class Drawing:
    """A short file that is drawn from the crest on."""

    rng: random.Random
    at_m: float = 0.0
    switches: list[float] = field(default_factory=list)
    positions: list[str] = field(default_factory=list)

    def switch(self) -> None:
        self.switches.append(round(self.at_m, 2))
        self.at_m += self.rng.uniform(12.0, 45.0)

    def position(self) -> None:
        length = self.rng.uniform(8.0, 30.0)
        end = f"to_m = {self.at_m + length:.1f}\n" if self.rng.random() < 0.5 else ""
        self.positions.append(f'[[position]]\ntype = "{self.rng.choice(TYPES)}"\nfrom_m = {self.at_m:.1f}\n{end}')
        self.at_m += self.rng.uniform(30.0, 60.0)

    def profile(self) -> list[list[float]]:
        """Steep at the crest, flat behind; sometimes of a wrong sign, or not from the crest on."""
        steep = self.rng.choice((30.0, 5.0, -20.0)) if self.rng.random() < 0.2 else 42.0
        begin, pieces = 3.0 if self.rng.random() < 0.05 else 0.0, []
        while begin < self.at_m:
            grade = steep * (1.0 - begin / self.at_m) ** 2 + self.rng.uniform(-1.0, 2.0)
            pieces.append([round(begin, 1), round(grade, 1)])
            begin += self.rng.uniform(5.0, 60.0)
        return [*pieces, [round(begin, 1), self.rng.choice((1.5, 0.8, 0.0, -1.0))]]


def random_short(seed: int) -> str:
    """The text of one."""
    rng = random.Random(seed)
    bunches = [rng.randint(1, 5) for _ in range(rng.randint(1, 3))]
    levels = (len(bunches) - 1).bit_length() + max((bunch - 1).bit_length() for bunch in bunches)
    levels += rng.choice((-1, 1)) if rng.random() < 0.05 else 0
    drawing = Drawing(rng, rng.uniform(20.0, 50.0))
    steps = [drawing.switch] * max(levels, 0) + [drawing.position] * rng.choice((0, 1, 1, 2, 2, 3))
    rng.shuffle(steps)
    for step in steps:
        step()
    lines = [f"tracks = {bunches[0]}" if len(bunches) == 1 else f"bunches = {bunches}"]
    if len(bunches) > 1 and rng.random() < 0.1:
        lines.append(f"tracks = {sum(bunches) + rng.randint(0, 1)}")
    lines += [f"switches_m = {drawing.switches}", f"profile_from_crest = {drawing.profile()}"]
    lines += [f"tracks_from_m = {drawing.at_m + rng.uniform(-5.0, 80.0):.1f}"]
    lines += [f"track_length_m = {rng.choice((20.0, 250.0, 600.0)) + rng.uniform(0.0, 300.0):.1f}"]
    lines += [f"{key} = {rng.uniform(*ends):.2f}" for key, ends in SPARE.items() if rng.random() < 0.2]
    lines += ["parallel_tracks = false"] if rng.random() < 0.2 else []
    return "\n".join((*lines, *drawing.positions)) + "\n"
