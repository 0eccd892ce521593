"""The pace of a study."""

import pytest

from rocking.app.studies.study import StudyPace


def test_a_steady_study_has_its_rate() -> None:
    """Fifty histories a second, looked at five times a second, are fifty histories a second."""
    pace = StudyPace()
    rates = [pace.look(10 * k, 0.0, now=0.2 * k)[0] for k in range(100)]
    assert rates[0] == 0.0
    assert rates[-1] == pytest.approx(50.0, rel=0.05)


def test_jumps_do_not_move_the_rate() -> None:
    """Chunks that are finished every two seconds give the mean rate between the jumps, too."""
    pace = StudyPace()
    rates = [pace.look(100 * (k // 10), 0.0, now=0.2 * k)[0] for k in range(200)]
    assert rates[150:] == pytest.approx([50.0] * 50, rel=0.25)


def test_a_study_that_hangs_slows_down() -> None:
    """Where nothing is finished for long, the rate goes down instead of promising an end."""
    pace = StudyPace()
    for k in range(50):
        pace.look(10 * k, 0.0, now=0.2 * k)
    assert pace.look(490, 0.0, now=60.0)[0] < 10.0


def test_work_of_two_workers_is_two_seconds_a_second() -> None:
    """Pieces of a second each from two workers, noticed in jumps, after a start that took long, and an earlier run."""
    pace = StudyPace()
    pace.look(1000, 500.0, now=0.0)
    speeds = [pace.look(1000 + 20 * (k // 5), 500.0 + 2.0 * (k // 5), now=7.0 + 0.2 * k)[1] for k in range(100)]
    assert speeds[0] == 0.0
    assert speeds[30:] == pytest.approx([2.0] * 70)
