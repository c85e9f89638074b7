"""Options of the command `bench`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from pydantic import field_validator

from synth.frame.settings.options import flag_option, number_option, word_option
from synth.retarder.options import TablesOptions

NONE: Final = "none"
MOST_PORT: Final = 65_535

LOCAL: Final = ("127.0.0.1", "localhost")
"""Hosts at which only this machine can connect."""


@dataclass(frozen=True)
class Address:
    """Where something is offered."""

    host: str
    port: int

    def __str__(self) -> str:
        return f"{self.host}:{self.port}"

    @property
    def pair(self) -> tuple[str, int]:
        """Host and port."""
        return self.host, self.port

    @property
    def is_wide(self) -> bool:
        """Whether other machines can connect there."""
        return self.host not in LOCAL


class BenchOptions(TablesOptions):
    """Options of the command line. An address is None where nothing is offered there."""

    modbus: Address | None = word_option(
        "--modbus", "HOST:PORT", Address("127.0.0.1", 5020), "Where Modbus TCP is spoken; none: nowhere."
    )
    opc_ua: Address | None = word_option("--opc-ua", "HOST:PORT", None, "Where OPC UA is spoken, too.")
    page: Address | None = word_option(
        "--page", "HOST:PORT", Address("127.0.0.1", 8020), "Where a browser sees the run; none: nowhere."
    )
    passes: int = number_option("--passes", "N", 45, 10, 1000, "Cuts that come; 45 take about ten minutes.")
    seed: int | None = number_option(
        "--seed", "N", None, 0, 2**63 - 1, "Of the random numbers; as configured unless given."
    )
    in_step: bool = flag_option("--in-step", "Go on as soon as the controller has answered, not by the clock.")

    @field_validator("modbus", "opc_ua", "page", mode="before")
    @classmethod
    def _is_an_address(cls, word: object) -> object:
        """Host and port, or none."""
        if not isinstance(word, str):
            return word
        if word == NONE:
            return None
        host, _, port = word.rpartition(":")
        if not host or not port.isascii() or not port.isdecimal() or not 1 <= int(port) <= MOST_PORT:
            raise ValueError(f"HOST:PORT, as 127.0.0.1:5020 for this machine alone, or {NONE}")
        return Address(host, int(port))

    @property
    def addresses(self) -> dict[str, Address]:
        """Where something is offered, by flag."""
        offered = {"--modbus": self.modbus, "--opc-ua": self.opc_ua, "--page": self.page}
        return {flag: address for flag, address in offered.items() if address is not None}
