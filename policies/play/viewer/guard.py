"""Refuses web pages that are not the viewer's own, and values that its page does not offer.

A browser lets any page open a connection to 127.0.0.1, and a page can give its own name that address (DNS
rebinding). The headers Origin and Host say which page asks and by which name it reached this machine. The
server of the page hands on whatever a browser sends: any text from a menu, any number from a slider.
"""

from __future__ import annotations

import asyncio
import ipaddress
import logging
import math
import socket
from collections.abc import Callable, Sequence
from typing import Any
from urllib.parse import urlsplit

MADE_FOR = "1.1.1"
"""Version of viser whose connections the viewer can check."""
_VIOLATION = 1008  # the close code of RFC 6455 for a policy that is violated
_MOST_WORDS = 20  # refused origins that are named on the terminal
_SHORT = 60  # characters of a refused value that a message shows


def is_own_page(hosts: list[str], origins: list[str], host: str) -> bool:
    """Whether the headers of a connection are those of a page that this server has sent.

    Its origin, which every browser sends, must be the address that it connects to, and the name in it must be
    one that no stranger can point to this machine: a number, localhost, the address that the server was asked
    to listen on, or the name of the machine.
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

    The `viser.ViserServer` offers no control yet.

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


def one_of(names: Sequence[str]) -> Callable[[Any], str]:
    """Takes a name of a menu; raises ValueError for anything else."""
    offered = tuple(names)

    def take(value: Any) -> str:
        if not isinstance(value, str) or value not in offered:
            raise ValueError(f"is not on offer; there are {', '.join(offered)}")
        return value

    return take


class Unfinished(ValueError):
    """A number out of range, as the first digits are of one that is typed into the box of a slider."""


def number(low: float, high: float, whole: bool = False) -> Callable[[Any], float]:
    """Takes a number of a slider; raises `Unfinished` for one out of range, ValueError for anything else."""

    def take(value: Any) -> float:
        words = f"must be a number from {low:g} to {high:g}"
        if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < math.inf:
            raise ValueError(words)
        if not low <= value <= high:
            raise Unfinished(words)
        if whole and value != math.floor(value):
            raise ValueError(f"must be a whole number from {low:g} to {high:g}")
        return int(value) if whole else float(value)

    return take


def switch(value: Any) -> bool:
    """Takes the state of a checkbox; raises ValueError for anything else."""
    if not isinstance(value, bool):
        raise ValueError("must be on or off")
    return value


class Offer:
    """A control of the page; viser has the handle, and messages name it by its label.

    `take` gives the value that is taken for one that was sent, see `number`; if that is not on offer,
    `refuse` is called with a message. An `Unfinished` one is not taken: the page sends the next digits, or
    the bound when the box is left.
    """

    def __init__(
        self, handle: Any, label: str, take: Callable[[Any], Any], refuse: Callable[[str], None]
    ) -> None:
        self._handle, self._label, self._take, self._refuse = handle, label, take, refuse
        self._value = handle.value

    @property
    def value(self) -> Any:
        """The last value that was on offer."""
        return self._value

    @value.setter
    def value(self, value: Any) -> None:
        self._value = self._handle.value = value

    def on_change(self, act: Callable[[Any], None]) -> None:
        """Calls `act` with the value whenever a user, and not the program, changed it."""
        self._handle.on_update(lambda event: self._changed(event, act))

    def on_click(self, act: Callable[[Any], None]) -> None:
        """Calls `act` with the value whenever a user clicked."""
        self._handle.on_click(lambda event: self._changed(event, act))

    def _changed(self, event: Any, act: Callable[[Any], None]) -> None:
        if event.client_id is None:
            return
        sent = self._handle.value
        try:
            self._value = self._take(sent)
        except Unfinished:
            return
        except ValueError as error:
            self._refuse(f"{self._label} = {repr(sent)[:_SHORT]} {error}")
            self._handle.value = self._value
            return
        act(self._value)
