"""Compilation of the estimators' kernels and their cache on disk.

`caching.compiler` stores programs under a digest of all that is compiled into them.
`entry_point` compiles the function of an estimator that Python calls, once, at import.
"""
