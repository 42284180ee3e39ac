"""A function's bits do not depend on which function had it compiled."""

import numpy as np
from numba import float64

from estimator._numba.caching import fused, njit
from slipgym._numba.compiled import compiled, compiled_sum


@compiled
def product(a: float, b: float, c: float) -> float:
    return a * b * c * c


@compiled_sum
def total(values: np.ndarray) -> float:
    result = 0.0
    for i in range(values.shape[0]):
        result += product(values[i], 3.0, 0.1)
    return result


@njit
def plain_product(a: float, b: float, c: float) -> float:
    return a * b * c


@fused
def total_of_products(a: float, b: float, c: float) -> float:
    return a * b + plain_product(a, b, c)


def test_a_function_called_by_a_sum_keeps_the_order_of_its_operations() -> None:
    total.part.compile((float64[::1],))
    assert "reassoc" in translated(total)
    assert "fmul" in translated(product)
    assert "reassoc" not in translated(product)


def translated(kernel) -> str:
    """Code of a function as a part of another one."""
    (part,) = kernel.part.overloads.values()
    return str(part.library.own_module())


def test_a_function_called_by_a_fused_one_rounds_as_before() -> None:
    total_of_products.part.compile((float64, float64, float64))
    assert "contract" in translated(total_of_products)
    assert "fmul" in translated(plain_product)
    assert "contract" not in translated(plain_product)
