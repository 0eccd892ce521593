"""What the server does before anybody asks."""

from rocking.app import server as warm_up
from rocking.app.api import impact
from rocking.evidence import calibrate


def test_warm_up_leaves_nothing_to_fit():
    """Afterwards the calibration is there, and an answer on the impact of a block."""
    warm_up.warm_up()
    fits = calibrate.cache_info().misses
    impact.warm_up()
    assert calibrate.cache_info().currsize == 1
    assert calibrate.cache_info().misses == fits


def test_what_is_not_installed_is_left_out(monkeypatch):
    """A picture that cannot be drawn without its extra does not end the thread with a traceback."""
    done = []

    def missing():
        raise ImportError("no matplotlib here")

    monkeypatch.setattr(warm_up, "_impact", missing)
    monkeypatch.setattr(warm_up, "_response", lambda: done.append("response"))
    monkeypatch.setattr(warm_up, "_picture", missing)
    warm_up.warm_up(lambda: done.append("more"))
    assert done == ["response", "more"]
