"""What a controller made of one cut."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby

from synth.retarder.bench.exchange import Answer
from synth.simulation.sampled_pass import PassEnd


@dataclass(frozen=True)
class AskedSample:
    """One sample: the stage in force `before`, that of the table in its place, and what stood in the end."""

    before: int
    by_table: int
    answer: Answer

    @property
    def is_changed(self) -> bool:
        """The controller commanded another stage."""
        return self.answer.stage != self.before

    @property
    def is_answered(self) -> bool:
        """Its answer came before the next sample."""
        return self.answer.response_s is not None


@dataclass(frozen=True)
class BenchPass:
    """A cut under the controller; `case`, `number`: which table's, and which of its row; `asked`: its samples."""

    case: int
    number: int
    end: PassEnd
    asked: tuple[AskedSample, ...]

    @property
    def samples(self) -> int:
        """How many there were."""
        return len(self.asked)

    @property
    def switchings(self) -> int:
        """Commands that changed the stage."""
        return sum(each.is_changed for each in self.asked)

    @property
    def unanswered(self) -> int:
        """Samples at whose end the stage before stood, for want of an answer."""
        return sum(not each.is_answered for each in self.asked)

    @property
    def moved_alone(self) -> int:
        """Samples at which the controller changed the stage and the table would not."""
        return sum(each.is_changed and each.by_table == each.before for each in self.asked)

    @property
    def held_alone(self) -> int:
        """The other way round."""
        return sum(not each.is_changed and each.by_table != each.before for each in self.asked)

    @property
    def response_s(self) -> float:
        """Longest time from a sample to its answer; 0 without any."""
        return max((each.answer.response_s or 0.0 for each in self.asked), default=0.0)

    @property
    def silence(self) -> int:
        """Most samples one after the other without an answer."""
        rows = groupby(self.asked, lambda each: each.is_answered)
        return max((len(list(row)) for is_answered, row in rows if not is_answered), default=0)
