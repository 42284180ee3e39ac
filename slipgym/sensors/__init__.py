"""Force/torque and slip-velocity sensors of the two fingers."""
