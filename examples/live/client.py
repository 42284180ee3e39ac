"""Sends a gripper's readings to `slipgym live --policy hold`, and obeys its commands.

Replace `read_wrench`, `read_twist` and `set_grip` by your drivers. Needs only Python.
"""

import json
import socket
import time

ADDRESS = ("127.0.0.1", 7741)
FIRM = 25.0  # N; when slipgym is silent
PATIENCE = 0.2  # s


def read_wrench(finger):
    """f_x, f_y, f_n, tau that load the pad [N, N, N, N m], 1000 times a second."""
    return [1.0, 0.0, 5.0, 0.0]


def read_twist(finger):
    """v_x, v_y, omega of the object against the pad [m/s, m/s, rad/s], 120 times a second."""
    return [0.0, 0.0, 0.0]


def set_grip(force):
    """The gripper's force loop [N]."""
    print(f"grip {force:.2f} N")


def main(seconds=2.0):
    door = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    door.setblocking(False)
    start = heard = time.monotonic()
    forces = velocities = 0
    while (now := time.monotonic()) - start < seconds:
        t = now - start
        lines = []
        if t >= forces / 1000.0:
            forces += 1
            lines += [{"finger": f, "t": t, "wrench": read_wrench(f)} for f in (1, 2)]
        if t >= velocities / 120.0:
            velocities += 1
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
        if now - heard > PATIENCE:  # slipgym, or the way to it, has failed: hold
            set_grip(FIRM)
            heard = now


if __name__ == "__main__":
    main()
