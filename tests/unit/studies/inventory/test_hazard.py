"""The shaking of an inventory: levels with units, motions scaled to them."""

import json

import pytest

from rocking.errors import InvalidValueError
from rocking.motions import peak_ground_velocity
from rocking.motions.motion import GroundMotion
from rocking.studies.inventory.hazard import Hazard, IntensityLevel

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
        ("PGA", "3e2cm/s2", 3.0),
        ("PGV", "25cm/s", 0.25),
        ("PGV", "0.25 m/s", 0.25),
    ],
)
def test_level_from_words(kind, words, value):
    """A number with its unit, in SI units inside."""
    assert IntensityLevel.of(kind, words).value == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(
    ("kind", "words"),
    [("PGA", "0.3"), ("PGA", "g"), ("PGA", "0,3g"), ("PGA", "-0.3g"), ("PGA", "0g"), ("PGA", "nang"), ("PGA", "1e9g"),
     ("PGA", "30cm/s"), ("PGV", "0.3g"), ("PGV", "1e999m/s"), ("PGA", 0.3), ("SA", "0.3g")],
)  # fmt: skip
def test_level_refused(kind, words):
    """Without a unit, of the wrong kind, or beyond any earthquake: refused, not guessed."""
    with pytest.raises(InvalidValueError, match=r"PGA|PGV"):
        IntensityLevel.of(kind, words)


def test_records_are_scaled_to_the_level():
    """Each record has the level, the vertical part goes along; without a level they are as they are."""
    scaled = Hazard.of_records(RECORDS, IntensityLevel("PGA", 4.0))
    assert [motion.peak for motion in scaled.motions] == pytest.approx([4.0, 4.0], rel=1e-14)
    assert scaled.motions[1].vertical.max() == pytest.approx(4.0 / 3.0, rel=1e-14)
    assert (scaled.vertical, scaled.synthetic, scaled.peak()) == (True, False, pytest.approx(4.0))
    velocity = Hazard.of_records(RECORDS, IntensityLevel("PGV", 0.5))
    assert [peak_ground_velocity(motion) for motion in velocity.motions] == pytest.approx([0.5, 0.5], rel=1e-12)
    assert velocity.velocity() == pytest.approx((0.5, 0.5))
    bare = Hazard.of_records(RECORDS)
    assert bare.motions == tuple(RECORDS)
    assert bare.words() == "PGA 0.204 to 0.306 g"
    json.dumps(bare.description)


def test_family_is_scaled_and_counted():
    """Every synthetic motion has the level; the progress hears of each."""
    told = []
    hazard = Hazard.of_family("point-source", IntensityLevel.of("PGV", "20cm/s"), count=4, seed=2, progress=told.append)
    assert [peak_ground_velocity(motion) for motion in hazard.motions] == pytest.approx([0.2] * 4, rel=1e-12)
    assert (sum(told), hazard.synthetic, hazard.words()) == (4, True, "PGV 0.2 m/s")
    assert "seed 2" in hazard.source


def test_refusals():
    """No records, too many motions, a record of stillness."""
    with pytest.raises(InvalidValueError, match="records must be 1 to"):
        Hazard.of_records([])
    with pytest.raises(InvalidValueError, match=r"count must be a whole number in \[1, 5000\]"):
        Hazard.of_family("point-source", IntensityLevel("PGA", 1.0), count=5001)
    with pytest.raises(InvalidValueError, match="'still': motion must have PGA > 0"):
        Hazard.of_records([GroundMotion([0.0, 0.0], 0.1, name="still")], IntensityLevel("PGA", 1.0))
    with pytest.raises(InvalidValueError, match=r"records\[0\] must be a GroundMotion"):
        Hazard.of_records(["a path"])
