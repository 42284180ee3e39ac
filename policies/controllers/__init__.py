"""Classic controllers, one file each."""
