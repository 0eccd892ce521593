"""Traffic lights: exact intervals, and every threshold at its edge."""

import math

import pytest
from scipy import stats

from rocking.errors import InvalidValueError
from rocking.statistics import share_interval
from rocking.studies.inventory.lights import Light, Thresholds, percent


@pytest.mark.parametrize(("hits", "count"), [(0, 7), (1, 7), (7, 7), (12, 200), (100, 200), (199, 200)])
def test_interval_is_that_of_clopper_and_pearson(hits, count):
    """At the ends of the interval the tails of the binomial distribution hold 2.5 % each; ends 0 and 1 are exact."""
    low, high = share_interval(hits, count)
    assert low <= hits / count <= high
    if hits:
        assert stats.binom.sf(hits - 1, count, low) == pytest.approx(0.025, rel=1e-9)
    else:
        assert low == 0.0
    if hits < count:
        assert stats.binom.cdf(hits, count, high) == pytest.approx(0.025, rel=1e-9)
    else:
        assert high == 1.0
    # negative control: the normal approximation is not it
    if 0 < hits < count:
        assert high != pytest.approx(hits / count + 1.96 * math.sqrt(hits * (count - hits) / count**3), rel=1e-3)


def light(count, overturned, high, lifted=None, failed=0):
    """Light by the default thresholds."""
    lifted = count if lifted is None else lifted
    return Thresholds().light(lifted=lifted, overturned=overturned, count=count, high_rotation=high, failed=failed)


@pytest.mark.parametrize(
    ("count", "overturned", "high", "lifted", "expected"),
    [
        (1, 0, 0.0, 0, Light.GREEN),
        (200, 0, 0.19, 200, Light.GREEN),
        (200, 0, 0.2, 200, Light.AMBER),
        (200, 1, 0.1, 200, Light.AMBER),
        (200, 39, None, 200, Light.AMBER),
        (200, 40, None, 200, Light.RED),
        # 0 of 72 bounds the share by 5 %, 0 of 71 does not: 1 - 0.025^(1/72) = 0.04994
        (72, 0, 0.1, 72, Light.GREEN),
        (71, 0, 0.1, 71, Light.AMBER),
        (1, 1, None, 1, Light.RED),
        (5, 1, 0.1, 1, Light.RED),
    ],
)
def test_lights_at_their_edges(count, overturned, high, lifted, expected):
    """Each threshold is where the report says it is."""
    assert light(count, overturned, high, lifted) is expected


def test_no_green_where_a_motion_could_not_be_computed():
    """What is not known is not safe."""
    assert light(200, 0, 0.0, lifted=0, failed=1) is Light.AMBER
    assert light(200, 0, 0.1, failed=1) is Light.AMBER


@pytest.mark.parametrize(("share", "count", "fell"), [(0.07, 100, 7), (0.14, 100, 14), (0.29, 100, 29), (0.2, 5, 1)])
def test_red_begins_at_its_share_whatever_the_rounding(share, count, fell):
    """Just as many as the share says are red, although 0.07 * 100 is above 7 in floats; one fewer is not."""
    limits = Thresholds(overturning_red=share)
    lights = [limits.light(lifted=count, overturned=n, count=count, high_rotation=0.5) for n in (fell - 1, fell)]
    assert lights == [Light.AMBER, Light.RED]


def test_small_shares_are_not_printed_as_zero():
    """A threshold of 0.5 % and a level of 99.9 % stand in the words as they are, not as 0 % and 100 %."""
    own = Thresholds(overturning_green=0.005, overturning_red=0.125, level=0.999)
    text = " ".join(own.sentences().values())
    for number in ("is at most 0.5% (", "the 99.9% interval", "At least 12.5% of"):
        assert number in text
    assert percent(0.07) == "7%"


def test_thresholds_stand_in_the_words():
    """Every number of the thresholds is printed, also of those of one's own."""
    own = Thresholds(rocking=0.35, overturning_green=0.02, overturning_red=0.11, level=0.9)
    text = " ".join(own.sentences().values())
    for number in ("0.35", "2%", "11%", "90%", "149 motions"):
        assert number in text
    assert 1.0 - 0.05 ** (1 / 149) <= 0.02 < 1.0 - 0.05 ** (1 / 148)


@pytest.mark.parametrize(
    "change",
    [{"rocking": 0.0}, {"rocking": 1.1}, {"overturning_green": 0.0}, {"overturning_red": 0.01}, {"level": 1.0},
     {"level": math.nan}],
)  # fmt: skip
def test_refusals(change):
    """Thresholds that make no sense are refused."""
    with pytest.raises(InvalidValueError, match=next(iter(change))):
        Thresholds(**change)
    with pytest.raises(InvalidValueError, match="hits must be in"):
        share_interval(3, 2)


def test_letters_differ_and_severity_orders():
    """Letters tell the lights apart without colours; red is worse than amber, amber than green."""
    assert {light.value for light in Light} == {"G", "A", "R"}
    assert Light.RED.severity > Light.AMBER.severity > Light.GREEN.severity
