"""Options of the commands that compute in many parts: who computes them."""

from __future__ import annotations

from synth.frame.faults import InputError
from synth.frame.settings.options import Options, number_option, word_option


class EngineOptions(Options):
    """Processes on this machine, or a Dask cluster."""

    workers: int | None = number_option(
        "--workers", "N", None, 1, 1024, "Processes on this machine; by default one a processor."
    )
    scheduler: str | None = word_option(
        "--scheduler", "ADDRESS", None, "Compute on the workers of this Dask scheduler instead."
    )

    def require_one(self, command: str) -> None:
        """`InputError` where both were typed behind `command`."""
        if self.workers is not None and self.scheduler is not None:
            raise InputError(f"{command}: --workers and --scheduler are both given; leave one out")
