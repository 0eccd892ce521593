"""Histories without a result, and those in which the ground would have to pull: counted, named, never a verdict."""

import numpy as np
import pytest

import rocking as rk
from rocking.conventions import DEFAULT_FRICTION, percent
from rocking.decision.inventory import InventoryObject, assess
from rocking.decision.inventory.hazard import Hazard
from rocking.decision.inventory.ranking import sentence
from rocking.dynamics.parameters import cut_words
from rocking.dynamics.rolling.batch import SpatialBatch
from rocking.outcome import Outcome, Status, contact_words, overturned
from rocking.plots import falling_picture, rocking_spectrum_picture
from rocking.studies import fragility_analysis
from rocking.studies.minimum_acceleration import Cases, Effort, searched

LEANING = rk.Section([rk.Region([(0.0, 0.0), (0.5, 0.0), (0.3, 2.0), (0.1, 2.0)], 2400.0)])
FALLS, STANDS, NONE = Outcome.OVERTURNED.code, Outcome.ROCKED.code, Outcome.FAILED.code


def test_outcomes_as_numbers():
    """1 and 0 for a result, whatever kept the body standing, and NaN for none."""
    found = overturned([outcome.code for outcome in Outcome])
    assert found[FALLS] == 1.0
    assert np.isnan(found[NONE])
    assert sum(found == 0.0) == len(Outcome) - 2


def test_batches_and_maps_say_so():
    """Two impacts allowed: rows that need more have no result, and the share of falls is that of the others."""
    pulses = [rk.pulses.sine(amplitude=a, period=0.8) for a in (2.0, 3.0, 4.0, 6.0)]
    found = rk.simulate_many(LEANING, pulses, 0.9, most_events=2)
    failed = (found["status"] == Status.TOO_MANY_EVENTS.code).to_numpy().ravel()
    assert failed.any()
    assert np.array_equal(np.isnan(found["overturned"].to_numpy().ravel()), failed)
    fell = found["outcome"].to_numpy().ravel() == FALLS
    assert fell.any()
    assert float(found["overturned"].mean()) == pytest.approx(fell.sum() / (~failed).sum())
    assert float(found["overturned"].mean()) != pytest.approx(fell.mean())  # negative control: no result as standing
    ratios = np.linspace(0.5, 4.0, 6)
    axes = ("frequency_ratio", ratios), ("amplitude_ratio", ratios)
    mapped = rk.overturning_map(LEANING, pulses[0], *axes, 0.9, most_events=2)
    assert np.array_equal(np.isnan(mapped["overturned"]), mapped["mode"] == -3)
    assert np.array_equal(mapped["overturned"] == 1.0, mapped["mode"] >= 0)


@pytest.mark.parametrize("body", [LEANING, rk.Block(width=0.5, height=2.0)], ids=["leaning", "block"])
def test_fragilities_say_so(body):
    """Of failed histories it is not known whether they rocked or fell; counts, curves and shares leave them out."""
    records = [rk.GroundMotion(np.sin(np.arange(200) * w), 0.01) for w in (0.05, 0.08, 0.11, 0.14, 0.2)]
    levels = [1.0, 4.0, 6.0, 9.0, 14.0]
    whole, cut = (
        fragility_analysis(body, records, levels, 0.9, limit_states=(0.5,), **o) for o in ({}, {"most_events": 2})
    )
    failed = cut.responses.outcome == NONE
    assert 0 < failed.sum() == cut.failed < failed.size
    for state in cut.limit_states:
        reached = cut.responses.exceed(state)
        assert np.array_equal(np.isnan(reached), failed)
        assert np.array_equal(reached[~failed], whole.responses.exceed(state)[~failed])
        assert cut.counts[state.name].tolist() == np.nansum(reached, axis=0).tolist()
    assert np.isnan(cut.responses.overturned).sum() == cut.failed
    assert cut.trials.tolist() == (~failed).sum(axis=0).tolist()
    assert cut.uplift.contradictions == 0
    assert cut.uplift.checked == (0 if body is LEANING else (~failed).sum())  # a level decides of equal sides alone


def spatial_batch(outcome):
    """A batch of one body, two motions, scales by outcome, two restitutions."""
    codes = np.broadcast_to(np.array(outcome)[None, None, :, None, None], (1, 2, len(outcome), 2, 1))
    values = {"outcome": codes.ravel(), "direction": np.zeros(codes.size)}
    values |= {"still_rocking": (codes.ravel() == STANDS).astype(np.int64)}
    labels = {"motion": ["a", "b"], "scale": list(range(1, 1 + len(outcome))), "restitution": ["housner-3d", "ked-3d"]}
    return SpatialBatch(codes.shape, values, "none", labels)


@pytest.mark.slow
def test_space_says_so():
    """Lost contact is no stand: one fall of two results is a half, in the batch and in its picture."""
    batch = spatial_batch([FALLS, STANDS, NONE, NONE])
    assert np.isnan(batch.overturned[0, 0, 2:]).all()
    assert batch.overturned[0, 0, :2, 0, 0].tolist() == [1.0, 0.0]
    assert batch.still_rocking[0, 0, :2, 0, 0].tolist() == [0.0, 1.0]
    assert np.isnan(batch.still_rocking[0, 0, 2:]).all()
    assert np.array_equal(batch.to_xarray()["still_rocking"], batch.still_rocking, equal_nan=True)
    figure = falling_picture(batch.to_xarray(), np.array([0.0, np.pi]))
    assert figure.axes[0].lines[0].get_ydata().tolist() == [50.0] * 3
    assert "0.0 % differ" in figure.axes[2].get_title(loc="left")
    nothing = falling_picture(spatial_batch([NONE]).to_xarray(), np.array([0.0, np.pi]))
    assert np.isnan(nothing.axes[0].lines[0].get_ydata()).all()


def test_spectra_have_no_share_without_results():
    """Periods at which nothing was computed have a gap, not a share of nought."""
    found = rk.rocking_spectrum([rk.pulses.sine(3.0, 0.6), rk.pulses.sine(5.0, 0.8)], [0.2], [1.0, 3.0], 0.9)
    found["mode"].to_numpy()[:, :, 0] = -3
    found["mode"].to_numpy()[:, :, 1] = [[-3], [2]]
    figure = rocking_spectrum_picture(found)
    share = figure.axes[1].lines[0].get_ydata()
    assert np.isnan(share[0])
    assert share[1] == 1.0


def test_ends_of_a_search_are_those_that_have_a_result():
    """Lowest accelerations without a result: what overturns first is not said of the lowest."""

    def run(values, body):
        ratio = values["scale"]
        mode = np.where(ratio < 2.0, -3, 1)
        return {"mode": mode, "side": np.ones_like(ratio), "peak_ratio": ratio, "overturning_time": ratio} | {
            "outcome": np.where(mode == -3, NONE, FALLS),
            "least_force": ratio,
        }

    sides = {f"{n}_{s}": np.array([0.2]) for n in ("alpha", "p", "r", "q") for s in ("right", "left")}
    case = Cases(sides, np.array([1.0]), np.array([1.0]), np.array([1.0]), np.array([8.0]), record=False)
    (found,) = searched(case, Effort(samples=9, bisections=0, tolerance=1e-3), run)
    assert found.starts_overturned
    assert found.min_pga == found.certain >= 2.0
    assert found.failed > 0


TIME = np.arange(300) * 0.01


def record(vertical: float, phase: float = 0.0) -> rk.GroundMotion:
    """A record of three seconds that rocks the body; its vertical part reaches that many g."""
    across = 4.0 * np.sin(2.0 * np.pi * 1.3 * TIME + phase)
    up = vertical * 9.80665 * np.sin(2.0 * np.pi * 4.7 * TIME + 2.0 * phase)
    return rk.GroundMotion(across, 0.01, vertical=up, name=f"{vertical:g} g up, phase {phase:g}")


HEAVY, LIGHT = [record(1.5, k) for k in range(4)], [record(0.05, k) for k in range(4)]


def test_shares_in_words():
    """All is 100 %, not 1e+02 %, what is not quite all is less, and small shares keep two digits."""
    assert "in 45 of 45 histories (100 %); " in contact_words([1.0] * 45)
    assert "in 2999 of 3000 histories (99.967 %); " in contact_words([1.0] * 2999 + [0.0])
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
            assert ("becomes tensile" in found.attrs["contact"]) is all_lost
        least = rk.minimum_overturning_acceleration(
            LEANING, motions[0], 0.8, samples=20, bisections=1, min_pga=2.8, max_pga=5.0
        )
        assert ("becomes tensile" in least.contact) is all_lost


@pytest.mark.slow
def test_fragilities_say_it():
    """Stripes and clouds count the histories, in their datasets and in what is printed."""
    for motions, all_lost in ((HEAVY, True), (LIGHT, False)):
        stripes = fragility_analysis(LEANING, motions, [3.0, 6.0], restitution=0.8)
        assert ("becomes tensile" in stripes.summary()["contact"]) is all_lost
        assert bool(stripes.dataset["lost_contact"].any()) is all_lost
        found = fragility_analysis(LEANING, motions, restitution=0.8, analysis="cloud")
        assert found.dataset.attrs["contact"] == found.responses.contact


def test_inventories_say_it():
    """The sentence of an object names the number of motions; a wrong count of the field would differ."""
    item = InventoryObject(name="column", width=0.5, depth=1.0, height=2.0)
    (heavy,) = (of_heavy := assess([item], Hazard.of_records(HEAVY))).verdicts
    (light,) = (of_light := assess([item], Hazard.of_records(LIGHT))).verdicts
    assert heavy.worse.lost_contact > 0
    assert f"The contact force becomes tensile in {heavy.worse.lost_contact} of these motions." in sentence(
        heavy, of_heavy
    )
    assert light.worse.lost_contact == 0
    assert "tensile" not in sentence(light, of_light)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::rocking.errors.PureRockingWarning")
def test_one_history_tells_both_verdicts():
    """Commands, page and report take the warnings of `Response.answer`: rocking alone, and with flight."""
    (words, *_) = rk.simulate(LEANING, HEAVY[0], 0.8).answer(0.5)["warnings"]
    assert "Rocking alone: " in words
    assert "With flight and a coefficient of friction of 0.5, as given: " in words
    # what nobody gave decides no flight, from whichever door it comes
    (assumed, *_) = rk.simulate(LEANING, HEAVY[0], 0.8).doubts(DEFAULT_FRICTION)
    (none,) = rk.simulate(LEANING, HEAVY[0], 0.8).doubts()
    assert assumed == none != words
    assert "a coefficient of friction of 10, because no friction is stated: " in none
    assert not any("pull" in each for each in rk.simulate(LEANING, LIGHT[0], 0.8).answer(0.5)["warnings"])
