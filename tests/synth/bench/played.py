"""A bench in this process, a controller in a thread, and the case that both play."""

from __future__ import annotations

import socket
import struct
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from typing import Any

from pymodbus.client import ModbusTcpClient
from pymodbus.exceptions import ModbusException

from synth.retarder.bench.bench_pass import BenchCase, BenchPass, bench_case, coming_cuts
from synth.retarder.bench.exchange import Exchange, InStep, Traffic
from synth.retarder.bench.live_run import LiveRun
from synth.retarder.bench.options import Address
from synth.retarder.bench.run import Bench, Patience
from synth.retarder.bench.servers import listening
from synth.retarder.bench.wires import COMMANDS_AT, TOLD_WIRES
from synth.retarder.fmi.variables import Kind
from synth.retarder.served_class import ServedClass
from tests.synth.case_factory import make_plant, make_table
from tuning_tables import ControllerTable, begin, decide_for, speed_for

SEED = 7
HOST = "127.0.0.1"
QUICK = Patience(gap_s=0.3, silent_s=0.2, first_s=20.0, end_s=3.0)


@cache
def the_case() -> BenchCase:
    """A table that decides at rest, and a few cuts."""
    plant = make_plant(36.0, 4)
    return bench_case(make_table("bench", plant, 3.0), 2, ServedClass("bench", plant), SEED, 8)


def free_port() -> int:
    """A port that nobody has."""
    with socket.socket() as one:
        one.bind((HOST, 0))
        return int(one.getsockname()[1])


def played(
    addresses: Mapping[str, Address], cuts: int, answer_s: float = 5.0
) -> tuple[tuple[BenchPass, ...], Traffic, list[str]]:
    """The passes of a run in step that waits `answer_s` for an answer, what was heard, and what was told."""
    case, told = the_case(), list[str]()
    exchange = Exchange(case.loop.stages)
    live = LiveRun("bench", cuts, exchange)
    bench = Bench(exchange, InStep(answer_s), case.loop.sensor.period_s, QUICK, told.append)
    with listening(exchange, addresses, {"/": lambda: b"<p>page</p>", "/now": live.document}):
        passes = bench.run([case], coming_cuts(SEED, 1, cuts), live, told.append)
        return passes, exchange.traffic, told


@contextmanager
def beside(act: Callable[[threading.Event], None]) -> Iterator[None]:
    """Within, `act` goes on in a thread, until it ends or is told to."""
    over = threading.Event()
    thread = threading.Thread(target=act, args=(over,))
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


class TableClient:
    """The rule of a table over Modbus, as a controller has it; `samples`: how many it has answered."""

    def __init__(self, table: ControllerTable, port: int) -> None:
        self._table, self._port = table, port
        self._state, self._pass = begin(), -1
        self.samples = 0

    def __call__(self, over: threading.Event, last: int | None = None) -> None:
        """Answer samples until `over`, or until so many are answered."""
        client: Any = ModbusTcpClient(HOST, port=self._port, retries=0)
        while not client.connect():
            over.wait(0.02)
        sample = -1
        try:
            while not over.is_set() and (last is None or self.samples < last):
                told = values_of(client.read_input_registers(0, count=17).registers)
                if told["sample"] != sample:
                    sample = int(told["sample"])
                    client.write_registers(COMMANDS_AT, [self.stage_for(told), sample])
                    self.samples += bool(told["present"])
        except (OSError, ModbusException):
            """The run is over."""
        finally:
            client.close()

    def stage_for(self, told: Mapping[str, float]) -> int:
        """What the table commands."""
        if not told["present"]:
            return 0
        if told["pass_number"] != self._pass:
            self._pass, self._state = int(told["pass_number"]), begin()
        measured = told["measured_m_s"]
        speed = speed_for(self._table, self._state, told["path_m"], measured, told["mean_overpressure_kpa"])
        stage = int(told["stage_in_force"])
        return decide_for(self._table, stage, told["path_m"], speed) if told["at_rest"] else stage


def values_of(registers: list[int]) -> dict[str, float]:
    """The values by name, read as the page of the command says."""
    found: dict[str, float] = {}
    for wire in TOLD_WIRES:
        if wire.variable.kind is Kind.FLOAT64:
            high, low = registers[wire.address : wire.address + 2]
            found[wire.name] = struct.unpack(">f", struct.pack(">HH", high, low))[0]
        else:
            found[wire.name] = registers[wire.address]
    return found
