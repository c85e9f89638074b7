"""How many random cuts an aim takes; alone, for the command line needs no more of a configuration."""

from __future__ import annotations

from synth.frame.settings.section import Section, setting


class SimulationSettings(Section):
    """Random cuts; speeds are chosen on some and judged on as many others."""

    passes: int = setting(
        20_000, "1", 1_000, 200_000, "cuts of each number of cars that speeds are chosen on; half as many others judge"
    )
    seed: int = setting(20261122, "1", 0, 2**53, "seed of the random streams")
    threads: int = setting(0, "1", 0, 256, "threads that roll cuts; 0: one a processor; changes no result")
