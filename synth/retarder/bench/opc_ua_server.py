"""The cable as OPC UA: one folder of variables; no user, no encryption."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from asyncua import ua
from asyncua.common.node import Node
from asyncua.server.server import Server

from synth.retarder.bench.exchange import Exchange, Values
from synth.retarder.bench.options import Address
from synth.retarder.bench.wires import ANSWERS, COMMAND_WIRES, OPC_UA_FOLDER, OPC_UA_NAMESPACE, STAGE, TOLD_WIRES, Wire


class OpcUaServer:
    """A server, and the nodes of what the position tells by name; made by `opc_ua_server`."""

    def __init__(self, server: Server, told: Mapping[str, Node]) -> None:
        self.server, self._told = server, told

    async def show(self, values: Values) -> None:
        """A new sample; its number comes last, so that who waits for it finds the rest."""
        for wire in (*TOLD_WIRES[1:], TOLD_WIRES[0]):
            await self.server.write_attribute_value(
                self._told[wire.name].nodeid, ua.DataValue(variant_of(wire, values[wire.name]))
            )


async def opc_ua_server(exchange: Exchange, address: Address) -> OpcUaServer:
    """A server that is not yet listening."""
    server = Server()
    await server.init()
    server.set_endpoint(f"opc.tcp://{address}/")
    server.set_server_name("retarder-synth bench")
    server.set_security_policy([ua.SecurityPolicyType.NoSecurity])
    server.allow_remote_admin(False)  # else the name "admin" would do to write what the position tells
    space = await server.register_namespace(OPC_UA_NAMESPACE)

    def id_of(name: str) -> ua.NodeId:
        return ua.NodeId(ua.String(name), ua.Int16(space))

    folder = await server.nodes.objects.add_object(id_of(OPC_UA_FOLDER), OPC_UA_FOLDER)

    async def node_of(wire: Wire) -> Node:
        return await folder.add_variable(id_of(f"{OPC_UA_FOLDER}.{wire.name}"), wire.name, variant_of(wire, 0.0))

    told = {wire.name: await node_of(wire) for wire in TOLD_WIRES}
    takers: dict[str, Callable[[int], bool | None]] = {STAGE.name: exchange.command, ANSWERS.name: exchange.answered}
    for wire in COMMAND_WIRES:
        node = await node_of(wire)
        await node.set_writable()
        server.set_attribute_value_setter(node.nodeid, setter(exchange, takers[wire.name]))
    return OpcUaServer(server, told)


def setter(exchange: Exchange, take: Callable[[int], bool | None]) -> Callable[..., None]:
    """What a client's value is given to; the library has seen that its type is that of the node, not that it is one."""

    def given(node: object, attribute: object, value: ua.DataValue) -> None:
        exchange.requested()
        word = None if value.Value is None else value.Value.Value
        if not isinstance(word, int):
            exchange.refuse("OPC UA: a command that is not one number")
            raise ua.uaerrors.BadTypeMismatch
        if take(word) is False:
            exchange.refuse("OPC UA: a stage that the position does not have")
            raise ua.uaerrors.BadOutOfRange

    return given


def variant_of(wire: Wire, value: float) -> ua.Variant:
    """A value in the type of its node."""
    return ua.Variant(wire.words.of(value), ua.VariantType[wire.words.node_type])
