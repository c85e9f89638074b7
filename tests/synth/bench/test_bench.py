"""The position at the end of a cable: who commands as the table gives the simulator's passes, whoever else talks."""

from __future__ import annotations

import asyncio
import json
import socket
import struct
import subprocess
import sys
import threading
import urllib.request
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from asyncua import ua
from asyncua.client.client import Client
from asyncua.ua.uaerrors import UaError, UaStatusCodeError
from pymodbus.client import ModbusTcpClient
from pymodbus.exceptions import ModbusException

from synth.retarder.bench.bench_pass import BenchPass
from synth.retarder.bench.exchange import Cycles, Exchange, RealTime
from synth.retarder.bench.options import Address
from synth.retarder.bench.wires import COMMANDS_AT, OPC_UA_FOLDER, OPC_UA_NAMESPACE, TOLD_WIRES
from tests.synth.bench.played import HOST, TableClient, beside, free_port, played, the_case

TOLERANCE = 1e-10
RESET = struct.pack("ii", 1, 0)
"""A socket of this `SO_LINGER` breaks its connection off where it is closed."""
WRONG = "BadOutOfRange", "BadTypeMismatch", "BadUserAccessDenied"
"""What is said of a stage that the position does not have, of two numbers, and of writing what it tells."""


def require_the_table(passes: Sequence[BenchPass], count: int) -> None:
    """Fail unless the passes are those of the simulator under the table."""
    by_table = the_case().by_table
    assert [each.number for each in passes] == list(range(count))
    for each in passes:
        assert each.end.exit_speed_m_s == pytest.approx(by_table.exit_speed_m_s[each.number], abs=TOLERANCE)
        assert each.switchings == by_table.switchings[each.number]
        assert (each.unanswered, each.moved_alone, each.held_alone) == (0, 0, 0)


def test_a_table_over_modbus_is_the_simulator_while_others_talk_nonsense(capfd: pytest.CaptureFixture[str]) -> None:
    modbus, page = Address(HOST, free_port()), Address(HOST, free_port())
    client, documents = TableClient(the_case().table, modbus.port), list[dict[str, Any]]()

    def nonsense(over: threading.Event) -> None:
        while not over.is_set():
            try:
                with urllib.request.urlopen(f"http://{HOST}:{page.port}/now") as found:
                    documents.append(json.loads(found.read()))
                for pair in (modbus.pair, page.pair):
                    with socket.create_connection(pair, 1.0) as one:
                        one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, RESET)
                        one.sendall(b"GET / HTTP/1.0\r\n\r\n" + bytes(range(256)) * 4)
                with ModbusTcpClient(HOST, port=modbus.port, retries=0) as other:
                    assert other.write_registers(COMMANDS_AT, [99, 0]).isError()
                    assert other.write_registers(0, [1]).isError()
                    assert other.write_coil(COMMANDS_AT, True).isError()
                    assert other.read_holding_registers(90, count=50).isError()
            except (OSError, ModbusException):
                over.wait(0.05)

    def flood(over: threading.Event) -> None:
        request = bytes((0, 1, 0, 0, 0, 6, 1, 4, 0, 0, 0, 17))
        while not over.is_set():
            try:
                with socket.create_connection(modbus.pair, 1.0) as one:
                    one.sendall(request * 500)
                    over.wait(0.01)
            except OSError:
                over.wait(0.05)

    with beside(client), beside(nonsense), beside(flood):
        passes, traffic, told = played({"--modbus": modbus, "--page": page}, 3)
    require_the_table(passes, 3)
    assert len(told) == 3
    assert traffic.impossible > 0
    assert traffic.refused > 3 * (traffic.impossible - 1)
    assert traffic.connections > 3
    assert {each["passes"] for each in documents} == {3}
    assert "Traceback" not in capfd.readouterr().err


def test_a_run_opens_no_file() -> None:
    """Clients may leave it no descriptor; in a process of its own, where no kernel is loaded yet."""
    text = """\
import sys
from synth.simulation.sampled_pass import sampled_pass
from tests.synth.bench.played import the_case

def refuse(event, words):
    if event == "open":
        raise OSError(f"it opens {words[0]}")

case = the_case()
sys.addaudithook(refuse)
rolling = sampled_pass(case.loop, case.common.draws.part(1, 2))
next(rolling)
rolling.send(2)
rolling.send(1)
"""
    subprocess.run([sys.executable, "-c", text], cwd=Path(__file__).parents[3], check=True)


def test_a_controller_that_vanishes_is_told_and_the_stage_before_stands() -> None:
    modbus, table = Address(HOST, free_port()), the_case().table

    def vanishing(over: threading.Event) -> None:
        client = TableClient(table, modbus.port)
        client(over, 30)
        over.wait(0.4)
        client(over, 60)

    with beside(vanishing):
        passes, traffic, told = played({"--modbus": modbus}, 3, answer_s=0.05)
    assert traffic.connections == 2
    assert any("the controller is silent; stage" in each for each in told)
    assert told[-1].startswith("no answer for ")
    assert len(passes) < 3
    assert all(each.unanswered < each.samples for each in passes)


def test_a_table_over_opc_ua_is_the_simulator() -> None:
    address = Address(HOST, free_port())
    names, client = [wire.name for wire in TOLD_WIRES], TableClient(the_case().table, 0)

    async def controlled(over: threading.Event) -> None:
        while not over.is_set():
            try:
                one = Client(f"opc.tcp://{address}/")
                one.set_user("admin")
                async with one as server:
                    await controller(server, over)
            except (TimeoutError, OSError, UaError):
                await asyncio.sleep(0.05)

    async def controller(server: Client, over: threading.Event) -> None:
        space = await server.get_namespace_index(OPC_UA_NAMESPACE)
        told = [server.get_node(f"ns={space};s={OPC_UA_FOLDER}.{name}") for name in names]
        stage, answers = (server.get_node(f"ns={space};s={OPC_UA_FOLDER}.{name}") for name in ("stage", "answers"))
        for node, word in ((stage, 99), (stage, [1, 2]), (told[0], 0)):
            with pytest.raises(UaStatusCodeError, match="|".join(WRONG)):
                await node.write_value(ua.Variant(word, ua.VariantType.UInt16))
        sample = -1
        while not over.is_set():
            values = dict(zip(names, await server.read_values(told), strict=True))
            if values["sample"] != sample:
                sample = values["sample"]
                words = [ua.Variant(word, ua.VariantType.UInt16) for word in (client.stage_for(values), sample)]
                await server.write_values([stage, answers], words)

    with beside(lambda over: asyncio.run(controlled(over))):
        passes, traffic, _ = played({"--opc-ua": address}, 2)
    require_the_table(passes, 2)
    assert (traffic.impossible, traffic.refused) == (1, 2)


def test_only_an_answer_to_this_sample_is_one() -> None:
    exchange = Exchange(3)
    exchange.tell({"sample": 5}, 1)
    assert (exchange.command(2), exchange.command(3), exchange.command(-1)) == (True, False, False)
    exchange.answered(4)
    assert (exchange.answer().stage, exchange.answer().response_s) == (2, None)
    exchange.answered(5)
    assert exchange.answer().response_s is not None


def test_a_cycle_counts_as_kept_within_a_tenth() -> None:
    cycles = Cycles(0.1, (0.1, 0.109, 0.111, 0.091, 0.089, 0.3), False)
    assert (cycles.off, cycles.worst_s, cycles.are_kept) == (3, 0.3, False)


def test_the_clock_makes_up_for_a_late_sample_and_not_for_a_stop() -> None:
    exchange, clock = Exchange(2), RealTime(0.02)
    for _ in range(10):
        exchange.tell({"sample": 0}, 0)
        clock.next_sample(exchange)
    assert sum(clock.cycles_s) >= 10 * 0.02 - 1e-3
    assert min(clock.cycles_s) > 0.0
