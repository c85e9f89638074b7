"""The machine that times were taken on, as a study keeps it beside them."""

from __future__ import annotations

import os
import platform
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

CPUINFO = Path("/proc/cpuinfo")


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
        cores=len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1,
        load_before=round(os.getloadavg()[0], 2),
        python=platform.python_version(),
        numpy=version("numpy"),
        numba=version("numba"),
    )


def processor_name(cpuinfo: Path = CPUINFO) -> str:
    """The processor's own name for itself where the system tells it, else its kind."""
    if cpuinfo.is_file():
        for line in cpuinfo.read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
