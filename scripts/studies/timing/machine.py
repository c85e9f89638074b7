"""The machine that times were taken on, as a study keeps it beside them."""

from __future__ import annotations

import os
import platform
from dataclasses import dataclass
from importlib.metadata import version

from synth.frame.processors import available, processor_name


@dataclass(frozen=True)
class Machine:
    """Processor, cores that this process may use, load of the last minute before the study, and software."""

    processor: str
    system: str
    cores: int
    load_before: float
    python: str
    numpy: str
    numba: str

    @property
    def sentence(self) -> str:
        """What a document says of it."""
        return (
            f"{self.processor}, {self.cores} cores, load {self.load_before:.1f} before; {self.system}; "
            f"Python {self.python}, numpy {self.numpy}, numba {self.numba}"
        )


def this_machine() -> Machine:
    """The machine as it is now."""
    return Machine(
        processor=processor_name(),
        system=f"{platform.system()} {platform.machine()}",
        cores=available(),
        load_before=round(os.getloadavg()[0], 2),
        python=platform.python_version(),
        numpy=version("numpy"),
        numba=version("numba"),
    )
