"""The cable as Modbus TCP: registers that any unit identifier reads by function 3 or 4, and writes by 6 or 16."""

from __future__ import annotations

from typing import Final

from pymodbus.constants import ExcCodes
from pymodbus.pdu import ModbusPDU
from pymodbus.server import ModbusTcpServer
from pymodbus.simulator import DataType, SimData, SimDevice

from synth.retarder.bench.exchange import Exchange
from synth.retarder.bench.options import Address
from synth.retarder.bench.wires import COMMAND_WIRES, COMMANDS_AT, TOLD_WIRES, registers_of

ANY_UNIT: Final = 0
OF_REGISTERS: Final = (3, 4, 6, 16, 22, 23)
"""Functions that read or write registers; the library would take single bits for them, too."""

WITHOUT_VALUES: Final = 0x80
"""Function codes of refusals are those of their requests and this."""


def modbus_server(exchange: Exchange, address: Address) -> ModbusTcpServer:
    """A server that is not yet listening."""
    read_only = sum(wire.words.registers for wire in TOLD_WIRES)
    stage, answers = (wire.address for wire in COMMAND_WIRES)

    async def on_access(
        function: int, start: int, first: int, count: int, registers: list[int], words: list[int] | list[bool] | None
    ) -> ExcCodes | None:
        if function not in OF_REGISTERS:
            return ExcCodes.ILLEGAL_FUNCTION
        if words is None:
            registers[:read_only] = registers_of(exchange.values)
            return None
        written = dict(enumerate(words, first))
        if stage in written and not exchange.command(int(written[stage])):
            return ExcCodes.ILLEGAL_VALUE
        if answers in written:
            exchange.answered(int(written[answers]))
        return None

    def on_message(is_sent: bool, message: ModbusPDU) -> ModbusPDU:
        if not is_sent:
            exchange.requested()
        elif message.isError():
            function = message.function_code - WITHOUT_VALUES
            exchange.refuse(f"Modbus: function {function} was refused with code {message.exception_code}")
        return message

    data = [
        SimData(0, count=read_only, datatype=DataType.REGISTERS, readonly=True),
        SimData(COMMANDS_AT, count=len(COMMAND_WIRES), datatype=DataType.REGISTERS),
    ]
    return ModbusTcpServer(
        SimDevice(ANY_UNIT, simdata=data, action=on_access),
        address=address.pair,
        trace_pdu=on_message,
        trace_connect=exchange.connected,
    )
