"""The pace of a study."""

import pytest

from rocking.app.studies.progress import Pace


def test_a_steady_study_has_its_rate() -> None:
    """Fifty histories a second, looked at five times a second, are fifty histories a second."""
    pace = Pace()
    rates = [pace.look(10 * k, now=0.2 * k) for k in range(100)]
    assert rates[0] == 0.0
    assert rates[-1] == pytest.approx(50.0, rel=0.05)


def test_jumps_do_not_move_the_rate() -> None:
    """Chunks that are finished every two seconds give the mean rate between the jumps, too."""
    pace = Pace()
    rates = [pace.look(100 * (k // 10), now=0.2 * k) for k in range(200)]
    assert rates[150:] == pytest.approx([50.0] * 50, rel=0.25)


def test_a_study_that_hangs_slows_down() -> None:
    """Where nothing is finished for long, the rate goes down instead of promising an end."""
    pace = Pace()
    for k in range(50):
        pace.look(10 * k, now=0.2 * k)
    assert pace.look(490, now=60.0) < 10.0
