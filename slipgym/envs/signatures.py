"""Gives the environments' classes the signature and the docstring of their keyword arguments."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable
from typing import TypeVar

from slipgym.envs.arguments import Field, fields

Class = TypeVar("Class", bound=type)


def documented(kind: type, *first: inspect.Parameter) -> Callable[[Class], Class]:
    """Decorator for a class whose constructor takes the arguments of a kind: signature and docstring.

    Args:
        kind: `ScalarArguments` or `VectorArguments`.
        *first: Parameters in front of them.
    """

    def decorate(cls: Class) -> Class:
        parameters = [
            inspect.Parameter(
                field.name, inspect.Parameter.KEYWORD_ONLY, default=field.default, annotation=field.annotation
            )
            for field in fields(kind).values()
        ]
        cls.__signature__ = inspect.Signature([*first, *parameters])
        if cls.__doc__ is not None:
            lines = [_paragraph(field) for field in fields(kind).values()]
            cls.__doc__ = cls.__doc__.replace("        {arguments}", "\n".join(lines))
        return cls

    return decorate


def _paragraph(field: Field) -> str:
    text = f"{field.name}: {field.text[0].upper()}{field.text[1:]}. Default: {field.default!r}."
    return textwrap.fill(text, 110, initial_indent=" " * 8, subsequent_indent=" " * 12)
