"""A chain of steps is its functions one after the other, and refuses what none of them takes."""

import math

import numpy as np
import pytest

from rocking import motions
from rocking.errors import InvalidValueError
from rocking.motions import GroundMotion, processed
from rocking.motions.components import Components
from rocking.motions.pipeline import STEPS, steps_of

pytestmark = pytest.mark.verifies(room="motions and records")

X, Y, Z = (
    GroundMotion(np.sin(np.arange(800) * rate) * np.hanning(800) + 0.02, 0.01, name=name)
    for rate, name in ((0.3, "x"), (0.2, "y"), (0.5, "z"))
)
ALL = Components(X, Y, Z)


@pytest.mark.verifies("invariant", "the functions one by one", within="every digit", control="within")
def test_a_chain_is_its_functions():
    """Mean, baseline, band pass, taper, resampling and scaling by words are the functions, each with its sentence."""
    words = "mean; baseline:order=2; bandpass:low=0.5,high=20; taper:fraction=0.1"
    words += "; resample:time_step=0.005; scale:pga=3"
    found = processed(X, words)
    one = motions.demeaned(X)
    one = motions.detrended(one, 2)
    one = motions.tapered(motions.bandpassed(one, 0.5, 20.0), 0.1)
    expected = motions.scaled_to(motions.resampled(one, 0.005), "pga", 3.0)
    assert found.acceleration.tolist() == expected.acceleration.tolist()
    assert found.provenance == expected.provenance
    assert len(found.provenance) == 6
    # negative control: the order of the steps matters
    assert processed(X, words.split(";")[::-1]).acceleration.tolist() != found.acceleration.tolist()
    assert processed(X, words.split(";")).acceleration.tolist() == found.acceleration.tolist()


@pytest.mark.verifies("closed form", "a filtered motion that ends at rest", within="1e-6", control="within")
def test_pads_that_are_kept_end_at_rest():
    """With its pads a band-passed motion ends at rest, to 1e-6 of its largest velocity; without them it does not."""
    for pads, still in (("keep", True), ("cut", False)):
        found = processed(X, f"bandpass:low=0.3,high=20,pads={pads}")
        velocity = motions.ground_velocity(found)
        assert bool(abs(velocity[-1]) < 1e-6 * np.abs(velocity).max()) is still
    kept = processed(X, "bandpass:low=0.3,high=20,pads=keep")
    count = math.ceil(1.5 * 4 / 0.3 / 0.01)
    assert len(kept) == len(X) + 2 * count
    assert kept.metadata["begins at"] == f"{-count * 0.01!r} s"
    assert kept.acceleration[count:-count].tolist() == motions.bandpassed(X, 0.3, 20.0).acceleration.tolist()


def test_components_are_treated_alike():
    """All three are cut at one time and scaled by one factor; turning by 90 degrees gives y and -x."""
    found = processed(ALL, "significant; scale:pga=3")
    assert len({len(part) for part in found.parts}) == 1
    assert found.peak == pytest.approx(3.0, rel=1e-12)
    cut = processed(ALL, "significant")
    assert found.y.peak / found.z.peak == pytest.approx(cut.y.peak / cut.z.peak, rel=1e-12)
    turned = processed(ALL, "rotate:angle=90")
    assert turned.x.acceleration == pytest.approx(Y.acceleration, abs=1e-15)
    assert turned.y.acceleration == pytest.approx(-X.acceleration, abs=1e-15)
    assert turned.z is Z
    with pytest.raises(InvalidValueError, match="two horizontal components"):
        processed(X, "rotate:angle=90")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("smooth", "step must be one of"),
        ("bandpass:low=1", "missing: high"),
        ("bandpass:low=1,high=2,hgih=3", "keys are low, high, order, pads"),
        ("bandpass:low=1,high=two", "must be a number"),
        ("bandpass:low=1,high=20,order=2.5", "must be a whole number"),
        ("bandpass:low=1,high=20,pads=some", "pads must be"),
        ("bandpass:low=1,high=80", "step bandpass: high must be"),
        ("trim:start=1,end=90", "step trim: end"),
        ("scale:factor=2,pga=3", "scale accepts"),
        ("scale:d5_95=3", "must grow with"),
        ("taper:fraction=0.1,fraction=0.2", "keys are fraction"),
        ("response:stations=missing.xml", "step response"),
    ],
)
def test_chains_that_make_no_sense_are_refused(words, message):
    """Steps, keys and values that are none are refused with the step's name."""
    with pytest.raises(InvalidValueError, match=message):
        processed(X, words)


@pytest.mark.parametrize(
    "words", ["pad:before=1e5", "mean; pad:before=0,after=3600.1", "pad:before=-1", "pad:before=nan"]
)
def test_a_padding_that_is_a_slip_is_refused_when_it_is_read(words):
    """Before any step is taken, with the range; an hour at both ends is still taken."""
    with pytest.raises(InvalidValueError, match=r"step pad: (before|after) must be (in \[0, 3600\]|finite)"):
        steps_of(words)
    assert len(processed(X, "pad:before=3600")) == len(X) + 2 * 360_000


def test_every_step_has_its_words():
    """Every step can be written, with its needed keys, and an empty chain changes nothing."""
    assert [name for name in STEPS if not STEPS[name].__doc__] == []
    assert processed(X, "") is X
    assert steps_of(["mean; taper", "pad:before=1"]) == [("mean", {}), ("taper", {}), ("pad", {"before": 1.0})]


def test_a_level_may_have_its_unit():
    """Accelerations in g are those in m/s2; a velocity takes none, and half a number is refused."""
    whole = processed(ALL, "scale:pga=2.941995")
    assert processed(ALL, "scale:pga=0.3g").x.peak == pytest.approx(whole.x.peak, rel=1e-12)
    assert processed(ALL, "scale:pga=300gal").x.peak != pytest.approx(whole.x.peak, rel=1e-3)
    for words in ("scale:pgv=0.3g", "scale:pga=1.2.3g"):
        with pytest.raises(InvalidValueError, match="must be a number"):
            processed(ALL, words)
