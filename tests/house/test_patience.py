import sys
import time

from slipgym._numba.compiled import patience


def test_only_what_takes_long_is_explained(capsys):
    with patience("nothing", after=60.0):
        pass
    with patience("something", after=0.0):
        time.sleep(0.2)
    assert capsys.readouterr().err.count("compiling") == 1


def test_a_terminal_sees_how_far_it_is(capsys, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with patience("something", 3, after=0.0) as one_more:
        one_more()
        time.sleep(0.5)
        one_more()
        time.sleep(0.5)
    shown = capsys.readouterr().err
    assert shown.index("1 of 3 programs, ") < shown.index("2 of 3 programs, ")
    assert shown.endswith(" s\n")
