import sys
import time

from slipgym._numba.compiled import _explain, patience


def test_only_what_takes_long_is_explained(capsys):
    with patience("nothing", after=60.0):
        pass
    _explain.cache_clear()
    for what in ("something", "something else"):
        with patience(what, after=0.0):
            time.sleep(0.2)
    assert capsys.readouterr().err.count("compiling for this machine") == 1


def test_a_terminal_sees_how_far_it_is(capsys, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with patience("something", 3, after=0.0) as one_more:
        one_more()
        time.sleep(0.5)
        one_more()
        time.sleep(0.5)
    shown = capsys.readouterr().err
    assert shown.index("#-- 1 of 3, ") < shown.index("##- 2 of 3, ")
    assert shown.endswith(" s\n")
