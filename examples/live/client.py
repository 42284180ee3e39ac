"""Sends a gripper's readings to `slipgym live --policy hold`, and obeys its commands.

    python client.py                    until Ctrl-C, then it holds firmly
    python client.py 10 --end open      for 10 s, then it opens

Replace `read_wrench`, `read_twist` and `set_grip` by your drivers. Needs only Python.
"""

import argparse
import json
import math
import signal
import socket
import time

ADDRESS = ("127.0.0.1", 7741)
FIRM, OPEN = 25.0, 0.0  # N; when slipgym is silent and at the end; without the object
PATIENCE = 0.2  # s


def read_wrench(finger):
    """f_x, f_y, f_n, tau that load the pad [N, N, N, N m], 1000 times a second."""
    return [1.0, 0.0, 5.0, 0.0]


def read_twist(finger):
    """v_x, v_y, omega of the object against the pad [m/s, m/s, rad/s], 120 times a second."""
    return [0.0, 0.0, 0.0]


def set_grip(force):
    """The gripper's force loop [N]; OPEN opens it."""
    print(f"grip {force:.2f} N")


def run(door, seconds, done):
    """Sends and obeys for some time, and counts in `done` what it did."""
    start = heard = time.monotonic()
    while (now := time.monotonic()) - start < seconds:
        t = now - start
        lines = []
        if t >= done["forces"] / 1000.0:
            done["forces"] += 1
            lines += [{"finger": f, "t": t, "wrench": read_wrench(f)} for f in (1, 2)]
        if t >= done["velocities"] / 120.0:
            done["velocities"] += 1
            lines += [{"finger": f, "t": t, "twist": read_twist(f)} for f in (1, 2)]
        if lines:
            door.sendto("\n".join(map(json.dumps, lines)).encode(), ADDRESS)
        try:
            answer = json.loads(door.recv(65535))
        except BlockingIOError:
            time.sleep(0.0002)
        else:
            heard = now
            if "error" in answer:
                print(answer["error"])
            if "command" in answer:
                set_grip(answer["grip_force"])
                done["commands obeyed"] += 1
        if now - heard > PATIENCE:  # slipgym, or the way to it, has failed: hold
            print("no answer: is slipgym live running?")
            set_grip(FIRM)
            done["silences"] += 1
            heard = now


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("seconds", type=float, nargs="?", default=math.inf, help="without it: until Ctrl-C")
    parser.add_argument("--end", choices=("hold", "open"), default="hold", help="the gripper at the end")
    asked = parser.parse_args()
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # kill ends as Ctrl-C does
    door = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    door.setblocking(False)
    done = dict.fromkeys(("forces", "velocities", "commands obeyed", "silences"), 0)
    set_grip(FIRM)
    try:
        run(door, asked.seconds, done)
    except KeyboardInterrupt:
        pass
    finally:
        set_grip(FIRM if asked.end == "hold" else OPEN)
        print(f"{', '.join(f'{n} {what}' for what, n in done.items())}; the gripper is told to {asked.end}")


if __name__ == "__main__":
    main()
