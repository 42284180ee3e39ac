"""The report of a study."""


def write_page(*_: object) -> None:
    """Nothing yet."""
