"""How functions are compiled: everything that touches internals of numba."""
