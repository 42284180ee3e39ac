"""Simulates the force loop of a finger: dead time, stiction, first-order lag, limits (arXiv 2410.19660).

The jaws are coupled, as a parallel gripper's are: what presses on either pad is the mean of both fingers'
forces. Unequal forces on an object at rest along the grip axis are impossible.

Static friction F in the transmission holds the force until the command has left it by F: Prandtl's play,
whose loops obey Masing's rule (Brokate & Sprekels, Hysteresis and Phase Transitions, Springer 1996, ch. 2).
A backlash b in front of a transmission of stiffness k is the same with F = k b / 2.
"""

from __future__ import annotations

from slipgym._numba.compiled import compiled
from slipgym.contact.decay import decay
from slipgym.contact.records import Pair
from slipgym.world.records import QUEUE, Finger, Records

FINGER_DAMPING = 10.0  # [N s/m]; equal forces leave fingers and box free to drift along the grip axis


@compiled
def actuator_force(finger: Finger, force: float) -> float:
    """Force that a finger's actuator settles at under a force command [N]."""
    return min(finger.gain * force, finger.force_limit)


@compiled
def queue_command(finger: Finger, tick: int, force: float) -> None:
    """Queue a force command [N]; it takes effect one dead time after `tick`.

    Stiction leaves no force when the force loop opens.
    """
    if force < finger.open_below:
        force = 0.0
    settled = actuator_force(finger, force)
    if finger.stiction > 0.0 and force > 0.0:
        settled = min(max(finger.settled, settled - finger.stiction), settled + finger.stiction)
    finger.settled = settled
    slot = finger.queued % QUEUE
    finger.queue_tick[slot] = tick + finger.dead_ticks
    finger.queue_force[slot] = settled
    finger.queued += 1


@compiled
def apply_due_commands(finger: Finger, tick: int) -> None:
    """Put the commands that are due into effect."""
    while finger.served < finger.queued and finger.queue_tick[finger.served % QUEUE] <= tick:
        finger.command = finger.queue_force[finger.served % QUEUE]
        finger.served += 1


@compiled
def ticks_to_next_command(finger: Finger, tick: int, horizon: int) -> int:
    """Ticks until the next queued command is due, at most `horizon`."""
    if finger.served < finger.queued:
        return min(horizon, finger.queue_tick[finger.served % QUEUE] - tick)
    return horizon


@compiled
def advance_lag(finger: Finger, h: float) -> float:
    """Advance the first-order lag by h; returns the mean force over h [N]."""
    gap = finger.force - finger.command
    if finger.lag <= 0.0:
        finger.force = finger.command
        return finger.command
    ratio = h / finger.lag
    if ratio != finger.relaxed:  # sub-steps take few lengths
        finger.relaxed, finger.decay = ratio, decay(ratio)
        finger.mean_decay = (1.0 - finger.decay) / ratio
        finger.early_decay = 2.0 * (1.0 - finger.mean_decay) / ratio
    finger.force = finger.command + gap * finger.decay
    return finger.command + gap * finger.mean_decay


@compiled
def advance_lag_through_commands(finger: Finger, tick: int, ticks: int, tick_length: float) -> Pair:
    """Advance the lag by some ticks, with the commands that fall due in them.

    Returns:
        The mean force, which changes the momentum, and the mean weighted by the time that is left, which
        moves the object within these ticks [N].
    """
    total, early, end = 0.0, 0.0, tick + ticks
    while tick < end:
        apply_due_commands(finger, tick)
        piece = ticks_to_next_command(finger, tick, end - tick)
        gap = finger.force - finger.command if finger.lag > 0.0 else 0.0
        mean = advance_lag(finger, piece * tick_length)
        tick += piece
        total += piece * mean
        early += piece * ((end - tick) * mean + 0.5 * piece * (finger.command + gap * finger.early_decay))
    return total / ticks, 2.0 * early / (ticks * ticks)


@compiled
def mean_force(fingers: Records) -> float:
    """Force on either pad now [N]: the mean over one finger or two."""
    total = 0.0
    for f in range(len(fingers)):
        total += fingers[f].force
    return total / len(fingers)


@compiled
def advance_fingers(fingers: Records, h: float) -> float:
    """Advance the lag of one finger or two by h; returns the force on either pad, its mean over h [N]."""
    total = 0.0
    for f in range(len(fingers)):
        total += advance_lag(fingers[f], h)
    return total / len(fingers)


@compiled
def advance_fingers_through_commands(fingers: Records, tick: int, ticks: int, tick_length: float) -> Pair:
    """`advance_lag_through_commands` of one finger or two; returns the means over the fingers."""
    total, early = 0.0, 0.0
    for f in range(len(fingers)):
        mean, weighted = advance_lag_through_commands(fingers[f], tick, ticks, tick_length)
        total, early = total + mean, early + weighted
    return total / len(fingers), early / len(fingers)


@compiled
def force_bounds(fingers: Records, tick: int) -> Pair:
    """Bounds of the force on either pad until a tick [N]: the lag moves it towards each command in turn."""
    least, most = 0.0, 0.0
    for f in range(len(fingers)):
        finger = fingers[f]
        low, high = min(finger.force, finger.command), max(finger.force, finger.command)
        for k in range(finger.served, finger.queued):
            if finger.queue_tick[k % QUEUE] < tick:
                low = min(low, finger.queue_force[k % QUEUE])
                high = max(high, finger.queue_force[k % QUEUE])
        least, most = least + low, most + high
    return least / len(fingers), most / len(fingers)


@compiled
def lowest_force(fingers: Records, tick: int, ticks: int, tick_length: float) -> float:
    """Lower bound of the force on either pad over some ticks [N], closer than `force_bounds`.

    Of several fingers the sum of each one's lowest force counts, at whatever time they have it.
    """
    total = 0.0
    for f in range(len(fingers)):
        finger = fingers[f]
        force, command, low, since = finger.force, finger.command, finger.force, tick
        for k in range(finger.served, finger.queued + 1):
            due = finger.queue_tick[k % QUEUE] if k < finger.queued else tick + ticks
            until = min(due, tick + ticks)
            left = decay((until - since) * tick_length / finger.lag) if finger.lag > 0.0 else 0.0
            force, since = command + (force - command) * left, until
            low = min(low, force)
            if due < tick + ticks:
                command = finger.queue_force[k % QUEUE]
        total += low
    return total / len(fingers)
