"""Numbers of the elements of a hump, a group for each kind: those of the control model ([kozachenko-control])."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from plant_models.errors import PlantError


class HumpError(PlantError):
    """A hump cannot be as it is described; `element` is the number of the element at fault, None where it is of all."""

    def __init__(self, sentence: str, element: int | None = None) -> None:
        super().__init__(sentence)
        self.element = element


class HumpErrors(HumpError):
    """All `errors` of a hump, at least one; `element` is that of the first."""

    def __init__(self, *errors: HumpError) -> None:
        super().__init__("; ".join(map(str, errors)), errors[0].element)
        self.errors = errors


@dataclass(frozen=True)
class NumberGroup:
    """The numbers `first` to `last` of one kind of elements, which messages call `noun`."""

    noun: str
    first: int
    last: int

    def __contains__(self, number: int) -> bool:
        return self.first <= number <= self.last

    def checked(self, number: int) -> int:
        """`number` itself; `HumpError` if it is not in the group."""
        if number not in self:
            raise HumpError(
                f"{self.noun} {number}: the number is not in its group; give a {self.noun} a number from {self.first} "
                f"to {self.last}",
                number,
            )
        return number


SWITCHES: Final = NumberGroup("switch", 1, 199)
SIGNALS: Final = NumberGroup("signal", 201, 399)
RETARDERS: Final = NumberGroup("retarder", 401, 599)
SECTIONS: Final = NumberGroup("section", 601, 799)
GROUPS: Final = (SWITCHES, SIGNALS, RETARDERS, SECTIONS)


def element_name(number: int) -> str:
    """'switch 7', 'signal 201', …; 'element 1000' for a number of no group."""
    noun = next((group.noun for group in GROUPS if number in group), "element")
    return f"{noun} {number}"


def in_brackets(name: str | None) -> str:
    """' (East 4)' behind a number; '' without a name."""
    return "" if name is None else f" ({name})"


def fault_of(element: int, sentence: str) -> HumpError:
    """The fault `sentence` of an element, whose name is put before it."""
    return HumpError(f"{element_name(element)}: {sentence}", element)
