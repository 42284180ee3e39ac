"""Measures the live estimator under faults: time inside, memory, losses, the estimates of the record."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import time
from array import array
from pathlib import Path
from typing import Any

import numpy as np

from estimator import records
from estimator.live import Live, Log
from estimator.live import records as of_log
from estimator.live.session import Session
from lab.live_streams import faulty, readings

REFUSED = ("late", "duplicate", "not_finite", "too_large", "jump", "clock", "width", "overflow")
OFFSET = 0.37
"""Of the clock of the velocities [s]."""


def accelerated(minutes: float, estimator: str, log: Path) -> list[str]:
    """Takes minutes of faulty readings of one finger as fast as it goes, and then the log as a record.

    Args:
        minutes: Of stamps.
        estimator: Its name.
        log: File to write.
    """
    book = Log(log)
    live = Live(estimator, fingers=1, clocks="arrival", lateness=0.004, log=book)
    session, memory = Session(live, log=book), []
    told, inside, work = array("d"), array("d"), array("d")
    for kind, t, values, arrival in faulty(readings(60.0 * minutes), lateness=0.002, offset=OFFSET):
        text = json.dumps({"finger": 1, "t": t, kind: values})
        begin, worked = time.perf_counter(), time.thread_time()
        answers = session.take(text, arrival)
        inside.append(time.perf_counter() - begin)
        work.append(time.thread_time() - worked)
        for answer in answers:
            told.extend([answer["t"], answer["mu_s"], answer["mu_c"], answer["r"]])
        if len(inside) % 25_000 == 1:
            memory.append(_resident())
    for output in live.flush():
        told.extend([output.t, output.estimate.mu_s, output.estimate.mu_c, output.estimate.r])
    book.close()
    lines = [
        f"{len(inside)} messages, {minutes:g} min of stamps, estimator {estimator}",
        session.report(),
        _percentiles("inside a message", 1e3 * np.array(inside)),
        _percentiles("of which this process worked", 1e3 * np.array(work)),
        f"resident memory {memory[1]:.0f} MB after 25 000 messages, {memory[-1]:.0f} MB at the end, of "
        f"which this measurement keeps {8e-6 * (2 * len(inside) + len(told)):.0f} MB",
        _lost(live),
    ]
    (record,) = of_log(log)[1]
    result = records.estimate(record, estimator, allow_gaps=True)
    found = np.array(told).reshape(-1, 4)
    same = len(found) == len(result.estimates) and all(
        np.array_equal(found[:, 1 + k], result.estimates[name])
        for k, name in enumerate(("mu_s", "mu_c", "r"))
    )
    lines.append(f"{len(found)} estimates, {'the same' if same else 'NOT the same'} bits as of the record")
    return lines


def by_udp(seconds: float, log: Path) -> list[str]:
    """Sends faulty readings of two fingers to `slipgym live` in real time, and kills it half-way.

    Args:
        seconds: Length [s].
        log: File that both of its runs write.
    """
    stream = sorted(
        (arrival, finger, kind, t, values)
        for finger in (1, 2)
        for kind, t, values, arrival in faulty(readings(seconds, finger), finger)
    )
    end = (
        f"{len(stream)} messages in {seconds:g} s by UDP; killed and started again half-way. The second run:"
    )
    client, port = socket.socket(socket.AF_INET, socket.SOCK_DGRAM), _free_port()
    client.setblocking(False)
    server, killed, sent, waits = _start(port, log), False, {}, []
    firm = unheard = began = 0
    start = time.monotonic()
    for arrival, finger, kind, t, values in stream:
        while (now := time.monotonic() - start) < arrival:
            try:
                answer = json.loads(client.recv(65535))
            except BlockingIOError:
                time.sleep(1e-4)
                continue
            if answer.get("estimate") and (answer["finger"], answer["t"]) in sent:
                wait = now - sent.pop((answer["finger"], answer["t"]))
                waits.extend([wait] if now - began > 1.0 else [])
            firm += "command" in answer and answer["status"] != "ok"
        if not killed and now > 0.5 * seconds:
            os.kill(server.pid, signal.SIGKILL)
            server.communicate()
            server, killed = _start(port, log), True
            now = began = time.monotonic() - start
        if arrival < now - 0.5:  # nobody listened
            unheard += 1
            continue
        if kind == "twist":
            sent[finger, t] = now
        text = json.dumps({"finger": finger, "t": t, kind: values})
        client.sendto(text.encode(), ("127.0.0.1", port))
    time.sleep(0.2)
    server.send_signal(signal.SIGTERM)
    printed, _ = server.communicate()
    client.close()
    same = [_same(log, finger) for finger in (1, 2)]
    return [
        end,
        printed.strip(),
        _percentiles(
            "from a velocity to its estimate, but for the first second of a run", 1e3 * np.array(waits)
        ),
        f"{unheard} messages while it was not there; {firm} firm commands",
        f"of both runs {sum(map(sum, same))} of {sum(map(len, same))} estimates are the bits of the record",
    ]


def _same(log: Path, finger: int) -> list[bool]:
    """For each estimate in a log, whether the record of its readings has the same."""
    from estimator.live import read

    told = [line for line in read(log) if "estimate" in line and line["finger"] == finger]
    wanted: dict[float, tuple[float, ...]] = {}
    for record in of_log(log)[finger]:
        result = records.estimate(record, "adaptive", allow_gaps=True)
        rows = result.estimates[["mu_s", "mu_c", "r"]].tolist()
        wanted.update(zip(result.samples.t.tolist(), rows, strict=True))
    return [wanted.get(line["t"]) == (line["mu_s"], line["mu_c"], line["r"]) for line in told]


def _start(port: int, log: Path) -> Any:
    words = ["--policy", "hold", "--port", str(port), "--log", str(log)]
    server = subprocess.Popen(
        [sys.executable, "-m", "slipgym", "live", *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert server.stderr is not None
    server.stderr.readline()
    return server


def _free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as door:
        door.bind(("127.0.0.1", 0))
        return door.getsockname()[1]


def _percentiles(what: str, milliseconds: np.ndarray) -> str:
    half, most, nearly = np.quantile(milliseconds, [0.5, 0.99, 0.999])
    return (
        f"{what}: median {half:.3f} ms, p99 {most:.3f} ms, p99.9 {nearly:.3f} ms, {milliseconds.max():.1f} ms"
    )


def _lost(live: Live) -> str:
    lost = sum(n["received"] - n["accepted"] - sum(n[why] for why in REFUSED) for n in live.counts.values())
    lost += sum(
        n["accepted"] - n["estimated"] - n["no_force"] - n["waiting"]
        for name, n in live.counts.items()
        if name.startswith("velocity")
    )
    return f"{lost} readings lost without a reason"


def _resident() -> float:
    """Memory of this process [MB]."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6
