"""Refuses web pages that are not the viewer's own.

A browser lets any page open a connection to 127.0.0.1, and a page can give its own name that address (DNS
rebinding). The headers Origin and Host say which page asks and by which name it reached this machine.
"""

from __future__ import annotations

import asyncio
import ipaddress
import logging
import socket
from typing import Any
from urllib.parse import urlsplit

MADE_FOR = "1.1.1"
"""Version of viser whose connections the viewer can check."""
_VIOLATION = 1008  # the close code of RFC 6455 for a policy that is violated
_MOST_WORDS = 20  # refused origins that are named on the terminal


def is_own_page(hosts: list[str], origins: list[str], host: str) -> bool:
    """Whether the headers of a connection are those of a page that this server has sent.

    Its origin must be the address that it connects to, and the name in it must be one that no stranger can
    point to this machine: a number, localhost, or the name of the server or machine.

    Args:
        hosts: Values of the header Host.
        origins: Values of the header Origin, which every browser sends.
        host: Address that the server was asked to listen on.
    """
    if len(hosts) != 1 or len(origins) != 1:
        return False
    try:
        origin, name = urlsplit(origins[0]), urlsplit(f"//{hosts[0]}").hostname
        if origin.scheme not in ("http", "https") or origin.netloc.lower() != hosts[0].lower() or not name:
            return False
        names = "localhost", host.lower(), socket.gethostname().lower()
        return name in names or ipaddress.ip_address(name) is not None
    except ValueError:  # of an address, or of a name that is none
        return False


def guard(server: Any, host: str) -> None:
    """Closes every connection that is not of an own page, before anything that it sends is read.

    Args:
        server: A `viser.ViserServer` that offers no control yet.
        host: Address that it was asked to listen on.

    Raises:
        RuntimeError: This version of viser does not show the headers of a connection.
    """
    try:
        sockets = server._websock_server
        connections, on_connect = sockets._live_connections, sockets.on_client_connect
    except AttributeError as error:
        server.stop()
        raise RuntimeError(
            f"this viser does not let the viewer check who connects: pip install viser=={MADE_FOR}"
        ) from error
    refused: set[str] = set()

    def is_welcome(connection: Any) -> bool:
        headers = connection.request.headers
        hosts, origins = headers.get_all("Host"), headers.get_all("Origin")
        welcome = is_own_page(hosts, origins, host)
        origin, name = (repr(", ".join(values)[:100]) for values in (origins, hosts))
        words = f"refused a page of the origin {origin}, which calls this machine {name}"
        if not welcome and words not in refused and len(refused) < _MOST_WORDS:
            refused.add(words)
            logging.getLogger(__name__).warning(words)
        return welcome

    async def check(client: Any) -> None:
        connection = connections[client.client_id]
        if not is_welcome(connection):
            await connection.close(_VIOLATION, "not a page of this server")
            task = asyncio.current_task()
            assert task is not None
            task.cancel()  # ends viser's handler of the connection before it reads a message

    async def sweep() -> None:
        for connection in list(connections.values()):
            if not is_welcome(connection):
                connection.transport.abort()

    on_connect(check)
    # the server has run since it was made: who came in before there was a check leaves again
    asyncio.run_coroutine_threadsafe(sweep(), server.get_event_loop()).result()
