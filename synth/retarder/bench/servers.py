"""Everything that listens, in threads of its own: no client can hold up the clock of the position for long."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import socket
import threading
from collections.abc import Awaitable, Callable, Iterator, Mapping
from concurrent.futures import Future
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib import import_module
from typing import Any, Final

from synth.frame.faults import InputError
from synth.retarder.bench.exchange import Exchange
from synth.retarder.bench.options import Address

LIBRARIES: Final = {"--modbus": "pymodbus.server", "--opc-ua": "asyncua"}
LOGGERS: Final = ("asyncua", "pymodbus", "asyncio")
GRACE_S: Final = 0.1
"""Requests that came last are still answered, so that none of them is left half done."""

WITHIN_S: Final = 60.0
"""A server that has not begun or ended by then never does."""

Pages = Mapping[str, Callable[[], bytes]]
"""What is shown, by path."""


def require_possible(addresses: Mapping[str, Address]) -> None:
    """`InputError` where an address cannot be listened at, two are one, or a library is missing."""
    if not addresses.keys() & LIBRARIES.keys():
        raise InputError("--modbus none, and no --opc-ua: no controller could come; give one of them an address")
    if len(set(addresses.values())) < len(addresses):
        raise InputError(f"{' and '.join(addresses)}: two of them name one address; give each a port of its own")
    for flag in addresses.keys() & LIBRARIES.keys():
        try:
            import_module(LIBRARIES[flag])
        except ImportError:
            raise InputError(f"{flag} needs what speaks it: pip install 'retarder-synth[bench]'") from None
    for flag, address in addresses.items():
        try:
            socket.create_server(address.pair).close()
        except (OSError, UnicodeError) as fault:
            said = str(getattr(fault, "strerror", None) or fault).partition(" (")[0]
            raise InputError(f"{flag} is {address}, where nothing can listen ({said}); give another") from None


@contextlib.contextmanager
def listening(exchange: Exchange, addresses: Mapping[str, Address], pages: Pages) -> Iterator[None]:
    """Within, controllers are served at `addresses`, and browsers with `pages`."""
    for name in LOGGERS:  # what clients do is counted, and told in the report
        logging.getLogger(name).setLevel(logging.CRITICAL + 1)
    with contextlib.ExitStack() as stack:
        if "--page" in addresses:
            stack.enter_context(page_served(addresses["--page"], pages))
        stack.enter_context(controllers_served(exchange, addresses))
        yield


@contextlib.contextmanager
def controllers_served(exchange: Exchange, addresses: Mapping[str, Address]) -> Iterator[None]:
    """Within, a loop in a thread serves controllers."""
    begun: Future[None] = Future()
    loop, over = asyncio.new_event_loop(), asyncio.Event()

    async def serve() -> None:
        async with contextlib.AsyncExitStack() as stack:
            try:
                for flag, begin in BEGINNINGS.items():
                    if flag in addresses:
                        await begin(exchange, addresses[flag], stack)
            except Exception as fault:
                begun.set_exception(fault)
                return
            begun.set_result(None)
            await over.wait()
        await asyncio.sleep(GRACE_S)

    thread = threading.Thread(target=loop.run_until_complete, args=(serve(),), daemon=True, name="controllers")
    thread.start()
    try:
        begun.result(WITHIN_S)
        yield
    finally:
        loop.call_soon_threadsafe(over.set)
        thread.join(WITHIN_S)
        loop.close()


async def begin_modbus(exchange: Exchange, address: Address, stack: contextlib.AsyncExitStack) -> None:
    """Serve Modbus until `stack` ends."""
    from synth.retarder.bench.modbus_server import modbus_server

    server: Any = modbus_server(exchange, address)  # some of its methods have no types
    await server.serve_forever(background=True)

    async def end() -> None:
        await server.shutdown()
        await asyncio.sleep(GRACE_S)
        for late in tuple(server.active_connections.values()):  # accepted while it closed
            late.close()

    stack.push_async_callback(end)


async def begin_opc_ua(exchange: Exchange, address: Address, stack: contextlib.AsyncExitStack) -> None:
    """The same of OPC UA, whose nodes are told each sample."""
    from synth.retarder.bench.opc_ua_server import opc_ua_server

    served, loop = await opc_ua_server(exchange, address), asyncio.get_running_loop()
    await stack.enter_async_context(served.server)

    def show(values: Mapping[str, float]) -> None:
        asyncio.run_coroutine_threadsafe(served.show(values), loop)

    exchange.hear(show)


BEGINNINGS: Final[Mapping[str, Callable[[Exchange, Address, contextlib.AsyncExitStack], Awaitable[None]]]] = {
    "--modbus": begin_modbus,
    "--opc-ua": begin_opc_ua,
}


@contextlib.contextmanager
def page_served(address: Address, pages: Pages) -> Iterator[None]:
    """Within, browsers are answered: HTML at "/", JSON elsewhere."""

    class Handler(BaseHTTPRequestHandler):
        timeout = WITHIN_S

        def do_GET(self) -> None:
            make = pages.get(self.path)
            content = b"" if make is None else make()
            self.send_response(404 if make is None else 200)
            kind = "text/html" if self.path == "/" else "application/json"
            self.send_header("Content-Type", f"{kind}; charset=utf-8")
            self.send_header("Content-Length", str(len(content)))
            self.send_header("Cache-Control", "no-store")
            self.end_headers()
            self.wfile.write(content)

        def log_message(self, format: str, *arguments: Any) -> None:
            """Nobody wants to know."""

    class Server(ThreadingHTTPServer):
        def handle_error(self, request: object, client_address: object) -> None:
            """A browser that went away, or spoke no HTTP: nobody wants to know that, either."""

    server = Server(address.pair, Handler)
    thread = threading.Thread(target=server.serve_forever, daemon=True, name="page")
    thread.start()
    try:
        yield
    finally:
        server.shutdown()
        server.server_close()
        thread.join()
