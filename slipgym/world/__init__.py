"""The engines that move the object: the planar engine, and PyBullet coupled to the same planar sub-steps."""
