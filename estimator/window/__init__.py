"""The parts of "adaptive": a robust fit over a moving window of slips."""
