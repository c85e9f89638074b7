"""How many trains are humped, and which; alone, for the command line needs no more of a configuration."""

from __future__ import annotations

from synth.frame.settings.section import Section, setting


class CountedTrains(Section):
    """Trains of a seed."""

    number: int = setting(200, "1", 1, 10_000_000, "trains that are humped")
    seed: int = setting(20261122, "1", 0, 2**53, "seed of the random streams; train k of a seed is always the same")
