"""How functions are compiled. Everything that touches numba's internals is here; see docs/numba.md.

Inner package: its names may change between versions.
"""
