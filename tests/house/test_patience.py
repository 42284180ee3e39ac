import time

from slipgym._numba.compiled import patience


def test_only_what_takes_long_is_explained(capsys):
    with patience("nothing", after=60.0):
        pass
    with patience("something", after=0.0):
        time.sleep(0.2)
    time.sleep(0.05)
    assert capsys.readouterr().err.count("compiling") == 1
