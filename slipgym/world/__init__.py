"""Worlds that move the object: a sub-stepped planar model, and PyBullet around it."""
