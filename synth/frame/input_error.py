"""The one error for a fault in what the user gave."""

from __future__ import annotations


class InputError(ValueError):
    """The input is at fault: one sentence for each fault, with file, key, value, what is allowed, what to do."""

    @property
    def sentences(self) -> tuple[str, ...]:
        """The faults, at least one."""
        return tuple(map(str, self.args))

    def __str__(self) -> str:
        return "\n".join(self.sentences)
