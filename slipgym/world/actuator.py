"""Force loop of a finger: dead time, first-order lag, limits (gripper paper, arXiv 2410.19660)."""

from __future__ import annotations

from slipgym._numba.compiled import compiled
from slipgym.contact.decay import decay
from slipgym.world.records import QUEUE


@compiled
def command(finger, tick, force):
    """Queue a force command [N]; it takes effect one dead time after `tick`."""
    if force < finger.open_below:
        force = 0.0
    slot = finger.queued % QUEUE
    finger.queue_tick[slot] = tick + finger.dead_ticks
    finger.queue_force[slot] = min(force, finger.force_limit)
    finger.queued += 1


@compiled
def take_up(finger, tick):
    """Put the commands that are due into effect."""
    while finger.served < finger.queued and finger.queue_tick[finger.served % QUEUE] <= tick:
        finger.command = finger.queue_force[finger.served % QUEUE]
        finger.served += 1


@compiled
def ticks_to_next(finger, tick, horizon):
    """Ticks until the next queued command is due, at most `horizon`."""
    if finger.served < finger.queued:
        return min(horizon, finger.queue_tick[finger.served % QUEUE] - tick)
    return horizon


@compiled
def least_force(finger, tick):
    """Least force until a tick [N]: the lag goes from the present one towards one command after the other."""
    least = min(finger.force, finger.command)
    for k in range(finger.served, finger.queued):
        if finger.queue_tick[k % QUEUE] < tick:
            least = min(least, finger.queue_force[k % QUEUE])
    return least


@compiled
def relax(finger, h):
    """Advance the first-order lag by h; returns the mean force over h [N]."""
    gap = finger.force - finger.command
    if finger.lag <= 0.0:
        finger.force = finger.command
        return finger.command
    ratio = h / finger.lag
    if ratio != finger.relaxed:  # sub-steps take few lengths
        finger.relaxed, finger.decay = ratio, decay(ratio)
        finger.mean_decay = (1.0 - finger.decay) / ratio
    finger.force = finger.command + gap * finger.decay
    return finger.command + gap * finger.mean_decay


@compiled
def relax_through(finger, tick, ticks, tick_length):
    """Advance the lag by some ticks, through the commands that fall due; returns the mean force [N]."""
    total, end = 0.0, tick + ticks
    while tick < end:
        take_up(finger, tick)
        piece = ticks_to_next(finger, tick, end - tick)
        total += piece * relax(finger, piece * tick_length)
        tick += piece
    return total / ticks
