"""Compilation of the estimators' kernels and their cache on disk.

`caching.compiler` makes numba's cache depend on all sources of a package, not only on the file that holds the
compiled function. `entry_point` compiles the function of an estimator that Python calls, once, at import.
"""
