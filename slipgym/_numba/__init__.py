"""Options of the compiler, pointers, fixed arguments and generated code; estimator/_numba has the rest.

Inner package: its names may change between versions.
"""
