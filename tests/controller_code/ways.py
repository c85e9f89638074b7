"""The ways of compiling C that a test goes through: few in each check, all of them with the long tests."""

from __future__ import annotations

from typing import Final

from scripts.studies.in_the_loop.builds import BUILDS, Build
from tests.effort import sized

USUAL_AND_FUSED: Final = ("gcc -O2", "clang -O3 -mfma -ffp-contract=fast without -std=c99")
UNLIKE: Final = (
    *USUAL_AND_FUSED,
    "gcc -O2 -mfpmath=387 without -std=c99",
    "arm-linux-gnueabihf-gcc -O2 -mthumb",
    "powerpc-linux-gnu-gcc -O2",
)
"""Registers of 80 bits, other processors, the highest byte first; and the two above."""


def ways_named(*names: str) -> tuple[Build, ...]:
    """Ways of compiling by what they are called."""
    return tuple(build for build in BUILDS if str(build) in names)


SANITIZED: Final = tuple(
    build for build in BUILDS if build.compiler == "gcc" and any("sanitize" in flag for flag in build.flags)
)
WAYS: Final = sized((*ways_named(*UNLIKE), *SANITIZED), BUILDS)
"""What each kind of tables is compiled in."""
FEW_WAYS: Final = ways_named(*USUAL_AND_FUSED)
"""What a book is compiled in whose code is a part of another one's."""
