"""Lights and the shaking that they are shown for: thresholds, intervals, levels, records."""

import json
import math

import pytest
from scipy import stats

from rocking.decision.inventory import Thresholds
from rocking.decision.inventory.hazard import Hazard, IntensityLevel
from rocking.decision.inventory.lights import Light
from rocking.errors import InvalidValueError
from rocking.motions import GroundMotion, peak_ground_velocity
from rocking.statistics import share_interval

pytestmark = pytest.mark.verifies(room="studies")


@pytest.mark.verifies("closed form", "tails of the binomial distribution", within="1e-9", control="within")
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
    assert "At least 7% of" in Thresholds(overturning_red=0.07).sentences()[Light.RED]


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


G = 9.80665
RECORDS = [GroundMotion([0.0, 1.0, -2.0, 0.0], 0.1, name="one"), GroundMotion([0.0, 3.0, 0.0], 0.1, [0.0, 1.0, 0.0])]


@pytest.mark.parametrize(
    ("kind", "words", "value"),
    [
        ("PGA", "0.3g", 0.3 * G),
        ("PGA", " 0.3 g ", 0.3 * G),
        ("PGA", ".3g", 0.3 * G),
        ("PGA", "2.5m/s2", 2.5),
        ("PGA", "300 gal", 3.0),
        ("PGA", "0,3g", 0.3 * G),
        ("PGA", "2,5 m/s2", 2.5),
        ("PGA", "3e2cm/s2", 3.0),
        ("PGV", "25cm/s", 0.25),
        ("PGV", "0.25 m/s", 0.25),
    ],
)
def test_level_from_words(kind, words, value):
    """A number with its unit, in SI units inside."""
    assert IntensityLevel.of(kind, words).value == pytest.approx(value, rel=1e-14, abs=0.0)


@pytest.mark.parametrize(
    ("kind", "words"),
    [("PGA", "0.3"), ("PGA", "g"), ("PGA", "1,234cm/s2"), ("PGA", "-0.3g"), ("PGA", "0g"), ("PGA", "nang"),
     ("PGA", "1e9g"),
     ("PGA", "30cm/s"), ("PGV", "0.3g"), ("PGV", "1e999m/s"), ("PGA", 0.3), ("SA", "0.3g")],
)  # fmt: skip
def test_level_refused(kind, words):
    """Without a unit, of the wrong kind, or beyond any earthquake: refused, not guessed."""
    with pytest.raises(InvalidValueError, match=r"PGA|PGV"):
        IntensityLevel.of(kind, words)


def test_records_are_scaled_to_the_level():
    """Each record has the level, the vertical part goes along; without a level they are as they are."""
    scaled = Hazard.of_records(RECORDS, IntensityLevel("PGA", 4.0))
    assert [motion.peak for motion in scaled.motions] == pytest.approx([4.0, 4.0], rel=1e-14, abs=0.0)
    assert scaled.motions[1].vertical.max() == pytest.approx(4.0 / 3.0, rel=1e-14, abs=0.0)
    assert (scaled.vertical, scaled.synthetic, scaled.peak()) == (True, False, pytest.approx(4.0))
    velocity = Hazard.of_records(RECORDS, IntensityLevel("PGV", 0.5))
    assert [peak_ground_velocity(motion) for motion in velocity.motions] == pytest.approx(
        [0.5, 0.5], rel=1e-12, abs=0.0
    )
    assert velocity.velocity() == pytest.approx((0.5, 0.5))
    bare = Hazard.of_records(RECORDS)
    assert bare.motions == tuple(RECORDS)
    assert bare.words() == "PGA 0.204 to 0.306 g"
    json.dumps(bare.description)


def test_family_is_scaled_and_counted():
    """Every synthetic motion has the level; the progress hears of each."""
    told = []
    hazard = Hazard.of_family("point-source", IntensityLevel.of("PGV", "20cm/s"), count=4, seed=2, progress=told.append)
    assert [peak_ground_velocity(motion) for motion in hazard.motions] == pytest.approx([0.2] * 4, rel=1e-12, abs=0.0)
    assert (sum(told), hazard.synthetic, hazard.words()) == (4, True, "PGV 0.2 m/s")
    assert "seed 2" in str(hazard.source)


def test_hazards_are_refused():
    """No records, too many motions, a record of stillness."""
    with pytest.raises(InvalidValueError, match="records must be 1 to"):
        Hazard.of_records([])
    with pytest.raises(InvalidValueError, match=r"count must be a whole number in \[1, 5000\]"):
        Hazard.of_family("point-source", IntensityLevel("PGA", 1.0), count=5001)
    with pytest.raises(InvalidValueError, match="'still': motion must have PGA > 0"):
        Hazard.of_records([GroundMotion([0.0, 0.0], 0.1, name="still")], IntensityLevel("PGA", 1.0))
    with pytest.raises(InvalidValueError, match=r"records\[0\] must be a GroundMotion"):
        Hazard.of_records(["a path"])
