"""Opens the UDP door: JSON lines in datagrams, answered to those who sent them."""

from __future__ import annotations

import contextlib
import json
import socket
import time
from collections.abc import Callable

from estimator.live.session import Session

PORT = 7741
TICK = 0.01
"""Time after which the watchdog is asked at the latest [s]."""
LINES = 64
"""Lines of a datagram at most."""
LISTENERS, STAYS = 8, 10.0
"""Senders that are answered at most, and for how long after their last message [s]."""


def opened(host: str = "127.0.0.1", port: int = PORT) -> socket.socket:
    """A socket to serve on; by default only programs of this machine reach it.

    Raises:
        OSError: The address is taken or none of this machine's; the message names it.
    """
    door = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        door.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        door.bind((host, port))
        door.settimeout(TICK)
    except OSError as error:
        door.close()
        raise OSError(error.errno, f"{host}:{port} (UDP): {error.strerror or error}") from error
    except BaseException:
        door.close()
        raise
    return door


def serve(session: Session, door: socket.socket, going: Callable[[], bool] = lambda: True) -> None:
    """Answers until `going` says no.

    It is asked after each datagram, of one or several lines, or tick. Every sender of a valid reading gets
    all estimates and commands; errors go to their sender alone.
    """
    listeners: dict[tuple[str, int], float] = {}
    while going():
        sender, data = None, b""
        try:
            data, sender = door.recvfrom(65535)
        except TimeoutError:
            pass
        except ConnectionResetError:  # Windows: somebody who was answered is gone
            continue
        now, answers = time.monotonic(), []
        lines = data.splitlines()
        if len(lines) > LINES:
            session.malformed[f"beyond the first {LINES} lines of a datagram"] += len(lines) - LINES
        for line in lines[:LINES]:
            found = session.take(line, now)
            errors = [answer for answer in found if "error" in answer]
            if errors and sender:
                _send(door, errors, [sender])
            elif sender and (sender in listeners or len(listeners) < LISTENERS):
                listeners[sender] = now
            answers += [answer for answer in found if "error" not in answer]
        answers += session.tick(now)
        for address in [address for address, last in listeners.items() if now - last > STAYS]:
            del listeners[address]
        _send(door, answers, list(listeners))


def _send(door: socket.socket, answers: list[dict], addresses: list[tuple[str, int]]) -> None:
    for answer in answers:
        line = json.dumps(answer, separators=(",", ":")).encode() + b"\n"
        for address in addresses:
            with contextlib.suppress(OSError):  # a full buffer: the next answer may get through
                door.sendto(line, address)
