"""Attacks on the public interface: interrupts, crafted files, inconsistent states, values without limit."""
