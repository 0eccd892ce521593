"""Where the ground would have to pull, studies say in how many histories, beside their verdicts; elsewhere nothing."""

import numpy as np
import pytest

import rocking as rk
from rocking.conventions import DEFAULT_FRICTION, percent
from rocking.dynamics.loss_of_contact import contact_words
from rocking.dynamics.parameters import cut_words
from rocking.reports.response_facts import response_facts
from rocking.studies.fragility._multiple_stripe_analysis import multiple_stripe_analysis
from rocking.studies.fragility.cloud_analysis import cloud
from rocking.studies.inventory.assessment import assess
from rocking.studies.inventory.hazard import Hazard
from rocking.studies.inventory.objects import InventoryObject
from rocking.studies.inventory.table import sentence

LEANING = rk.Section([rk.Region([(0.0, 0.0), (0.5, 0.0), (0.3, 2.0), (0.1, 2.0)], 2400.0)])
TIME = np.arange(300) * 0.01


def record(vertical: float, phase: float = 0.0) -> rk.GroundMotion:
    """A record of three seconds that rocks the body; its vertical part reaches that many g."""
    across = 4.0 * np.sin(2.0 * np.pi * 1.3 * TIME + phase)
    up = vertical * 9.80665 * np.sin(2.0 * np.pi * 4.7 * TIME + 2.0 * phase)
    return rk.GroundMotion(across, 0.01, vertical=up, name=f"{vertical:g} g up, phase {phase:g}")


HEAVY, LIGHT = [record(1.5, k) for k in range(4)], [record(0.05, k) for k in range(4)]


def test_shares_in_words():
    """All is 100 %, not 1e+02 %, what is not quite all is less, and small shares keep two digits."""
    assert "in 45 of 45 histories (100 %) " in contact_words([1.0] * 45)
    assert "in 2999 of 3000 histories (99.967 %) " in contact_words([1.0] * 2999 + [0.0])
    assert "distribution 99.7 % cut off" in cut_words({"left": 0.997, "right": 0.997})
    shares = {0.0: "0 %", 3.1e-4: "0.031 %", 0.0078: "0.78 %", 0.14: "14 %", 0.9949: "99.5 %", 12.344: "1230 %"}
    assert {share: percent(share) for share in shares} == shares


def test_maps_spectra_and_searches_say_it():
    """Under 1.5 g up and down most bodies lose contact before they fall, under 0.05 g none does."""
    axes = ("scale", [0.5, 1.0, 1.5]), ("restitution", [0.7, 0.8])
    for motions, all_lost in ((HEAVY, True), (LIGHT, False)):
        mapped = rk.overturning_map(LEANING, motions[0], *axes)
        spectrum = rk.rocking_spectrum(motions, [0.2], [1.0, 3.0], 0.8)
        for found in (mapped, spectrum):
            lost = int(found["lost_contact"].sum())
            assert lost == int((found["least_force"] < 0.0).sum())
            assert (lost > 0) is all_lost
            assert found.attrs["contact"] == contact_words(found["lost_contact"])
            assert ("would have to pull" in found.attrs["contact"]) is all_lost
        least = rk.minimum_overturning_acceleration(
            LEANING, motions[0], 0.8, points=20, levels=1, lowest=2.8, highest=5.0
        )
        assert ("would have to pull" in least.contact) is all_lost


def test_fragilities_say_it():
    """Stripes and clouds count the histories, in their datasets and in what is printed."""
    for motions, all_lost in ((HEAVY, True), (LIGHT, False)):
        stripes = multiple_stripe_analysis(LEANING, motions, [3.0, 6.0], restitution=0.8)
        assert ("would have to pull" in stripes.summary()["contact"]) is all_lost
        assert bool(stripes.dataset["lost_contact"].any()) is all_lost
        found = cloud(LEANING, motions, restitution=0.8)
        assert found.dataset.attrs["contact"] == found.responses.contact


def test_inventories_say_it():
    """The sentence of an object names the number of motions; a wrong count of the field would differ."""
    item = InventoryObject(name="column", width=0.5, depth=1.0, height=2.0)
    (heavy,) = (of_heavy := assess([item], Hazard.of_records(HEAVY))).verdicts
    (light,) = (of_light := assess([item], Hazard.of_records(LIGHT))).verdicts
    assert heavy.worse.lost_contact > 0
    assert f"in {heavy.worse.lost_contact} the ground would have to pull" in sentence(heavy, of_heavy)
    assert light.worse.lost_contact == 0
    assert "pull" not in sentence(light, of_light)


@pytest.mark.filterwarnings("ignore::rocking.errors.PureRockingWarning")
def test_one_history_tells_both_verdicts():
    """Commands, page and report take the warnings of `response_facts`: rocking alone, and with flight."""
    (words, *_) = response_facts(rk.simulate(LEANING, HEAVY[0], 0.8), 0.5)["warnings"]
    assert "rocking alone: " in words
    assert "if it may fly, with a coefficient of friction of 0.5, as given: " in words
    # what nobody gave decides no flight, from whichever door it comes
    (assumed, *_) = rk.simulate(LEANING, HEAVY[0], 0.8).doubts(DEFAULT_FRICTION)
    (none,) = rk.simulate(LEANING, HEAVY[0], 0.8).doubts()
    assert assumed == none != words
    assert "with a coefficient of friction of 10, since none was given: " in none
    assert not any("pull" in each for each in response_facts(rk.simulate(LEANING, LIGHT[0], 0.8), 0.5)["warnings"])
