"""Estimates friction while a gripper runs, and commands its grip."""

import signal
import threading
from collections.abc import Callable
from contextlib import ExitStack, closing
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated, Any

import typer

from estimator import DEFAULT
from policies.commands.several import taking_several, usage_errors

EPILOG = """
Examples:\n
\b
  slipgym live
  slipgym live --policy hold --log run.jsonl
  slipgym live --policy hold_scratch --column time_left=4 --set r_max=0.02
  slipgym live --door ros2 --clocks arrival
\n
The door udp takes JSON lines, {"finger": 1, "t": 0.001, "wrench": [f_x, f_y, f_n, tau]} or "twist": [v_x,
v_y, omega], and answers with estimates and commands. docs/live.md describes them, and examples/live/ has
clients in Python and C.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG, cls=taking_several("--set", "--column"))
def main(
    policy: Annotated[
        str | None, typer.Option(help="Name of a policy, or its folder; without one nothing is commanded.")
    ] = None,
    task: Annotated[
        str | None, typer.Option(help="For a controller of every task: its observations.")
    ] = None,
    column: Annotated[
        list[str] | None, typer.Option(metavar="NAME=VALUE", help="Of the observation; messages change it.")
    ] = None,
    firm: Annotated[
        float | None, typer.Option(help="Grip when data stop [N]; the gripper's largest.")
    ] = None,
    timeout: Annotated[float, typer.Option(help="Silence after which the grip is firm [s].")] = 0.1,
    estimator: Annotated[str, typer.Option(help="Name of the estimator.")] = DEFAULT,
    set_: Annotated[
        list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Its parameters; repeatable.")
    ] = None,
    fingers: Annotated[int, typer.Option(min=1, max=2, help="With sensors.")] = 2,
    force_rate: Annotated[float, typer.Option(help="Of each force sensor [Hz].")] = 1000.0,
    velocity_rate: Annotated[float, typer.Option(help="Of each slip-velocity sensor [Hz].")] = 120.0,
    lateness: Annotated[float, typer.Option(help="How late a reading may be [s].")] = 0.002,
    clocks: Annotated[str, typer.Option(help="stamps: one clock. arrival: each sensor its own.")] = "stamps",
    log: Annotated[Path | None, typer.Option(help="JSON lines to append all that passes to.")] = None,
    mcap: Annotated[Path | None, typer.Option(help="At the end, the log as MCAP.")] = None,
    door: Annotated[str, typer.Option(help="udp, ros2 or rosbridge.")] = "udp",
    host: Annotated[
        str, typer.Option(help="Address to listen at, or of the rosbridge; 0.0.0.0: the network.")
    ] = "127.0.0.1",
    port: Annotated[int | None, typer.Option(min=0, max=65535, help="7741; rosbridge: 9090.")] = None,
    seconds: Annotated[float | None, typer.Option(help="End by itself.")] = None,
) -> None:
    """Estimate friction from the readings of a running gripper, and command its grip."""
    from estimator.live import Live, Log
    from estimator.live.session import Session
    from estimator.records import parse_settings
    from slipgym.atomic_io import check_file

    if door not in ("udp", "ros2", "rosbridge"):
        raise typer.BadParameter(f"{door!r}: expected udp, ros2 or rosbridge", param_hint="--door")
    if mcap is not None and log is None:
        raise typer.BadParameter("--mcap converts the log: give --log")
    try:
        if mcap is not None:
            if find_spec("mcap") is None:
                raise ModuleNotFoundError("--mcap: mcap is not installed: pip install 'slipgym[live]'")
            check_file(mcap)
        columns, pilot = parse_settings(column or (), "--column"), None
        if columns and policy is None:
            raise ValueError("--column is for a --policy")
        rates = force_rate, velocity_rate
        live = Live(estimator, fingers, rates, lateness, clocks, **parse_settings(set_ or ()))
        if policy is not None:
            from policies.live import PolicyPilot

            pilot = PolicyPilot(policy, live, task, columns, firm, timeout)
        session = Session(live, pilot)
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGTERM, signal.default_int_handler)  # of a service; as Ctrl-C
        with ExitStack() as files:

            @cache
            def begin() -> None:
                """Opens the log; a start that fails before leaves it as it was."""
                if log is not None:
                    session.begin_log(files.enter_context(closing(Log(log))))

            _serve(session, door, host, port, fingers, seconds, begin)
    except (ValueError, OSError, ModuleNotFoundError) as error:
        raise typer.BadParameter(str(error)) from error
    typer.echo(session.report())
    if mcap is not None and log is not None:
        from estimator.live.log import to_mcap

        with usage_errors(ModuleNotFoundError, OSError, ValueError, hint="--mcap"):
            typer.echo(f"{to_mcap(log, mcap)} messages: {mcap}")


def _serve(
    session: Any, door: str, host: str, port: int | None, fingers: int, seconds: float | None,
    begin: Callable[[], None],
) -> None:  # fmt: skip
    """Serves until the end; `begin` is called once the door is open."""
    import time

    end = None if seconds is None else time.monotonic() + seconds

    def going() -> bool:
        begin()
        return end is None or time.monotonic() < end

    from estimator.live import ros, udp

    try:
        if door == "udp":
            with udp.opened(host, udp.PORT if port is None else port) as socket:
                begin()
                address = "{}:{}".format(*socket.getsockname())
                typer.echo(f"listening at {address} (UDP); Ctrl-C ends", err=True)
                if host != "127.0.0.1":
                    typer.echo("Warning: whoever reaches this address can move the grip", err=True)
                udp.serve(session, socket, going)
        elif door == "ros2":
            ros.serve_ros2(session, fingers, going)
        else:
            ros.serve_rosbridge(session, fingers, host, 9090 if port is None else port, going)
    except KeyboardInterrupt:
        pass
    finally:
        session.live.flush()
