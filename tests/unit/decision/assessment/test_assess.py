"""`assess`: its verdicts, margins, components, and what it refuses."""

import itertools
import math
import re
from types import SimpleNamespace

import numpy as np
import pytest

import rocking as rk
import rocking.decision.remedies
from rocking.conventions import g
from rocking.decision.assessment._assess import DIRECTIONS, choices, in_the_plane
from rocking.decision.assessment.answer import _cases, millimetres, rounded_up
from rocking.decision.remedies import Landings, Margins, changed, remedies
from rocking.errors import InvalidValueError
from rocking.studies import SyntheticSet

pytestmark = pytest.mark.slow

CABINET = rk.Block(width=0.8, height=2.2, depth=1.2, mass=650.0, centre=(0.52, 0.9))


def record(peak, period=0.8, **more):
    """A sine of two periods as a record."""
    time = np.arange(0.0, 2.0 * period, 0.01)
    return rk.GroundMotion(peak * np.sin(2.0 * math.pi * time / period), 0.01, name=f"sine of {peak:g}", **more)


def test_it_stands():
    """What does not lift needs nothing, and its margin is above one."""
    found = rk.assess(CABINET, record(2.0), ["ked", "housner"], count=16)
    assert found.verdict.startswith("No uplift and no overturning: 0 of 1 motion")
    assert found.lowest.factor > found.uplift_factors[0] == pytest.approx(9.80665 * 0.28 / 0.9 / 2.0, rel=1e-3)
    assert found.measures == ("None required: no uplift under this record.",)
    assert found.remedies.tension == {"left": 0.0, "right": 0.0}
    assert f"{found.lowest.factor:.3g} times this record" in found.margin_sentence


def test_it_overturns():
    """The margin is the least factor of all: a history just below stands with every model, just above one falls."""
    found = rk.assess(CABINET, record(9.0), ["ked", 0.85], count=16)
    factor, name, motion, mirrored = found.lowest
    assert [found.verdict.facts[name] for name in ("count", "with_all", "with_some")] == [1, 1, 1]
    assert factor == min(each.min_factor for each in found.models.values()) < 1.0
    choice = choices(CABINET, ["ked", 0.85])[name]
    body = CABINET.mirrored() if mirrored else CABINET
    ends = [rk.simulate(body, found.motions[motion], choice, scale=k * factor).outcome for k in (0.998, 1.002)]
    assert ends[1] is rk.Outcome.OVERTURNED
    assert ends[0] is not rk.Outcome.OVERTURNED
    assert [words.partition(" ")[0] for words in found.measures] == ["Anchors", "Base", "Centre", "Isolators"]
    assert found.sentences == tuple(str(found).splitlines())


@pytest.mark.parametrize("seed", [1, 2])
def test_what_helps_is_seen_by_the_search_for_the_margin(seed, monkeypatch):
    """The body that is changed as advised has a margin above one; a look at 0.6 to 1 times the motion is not enough."""
    motion = SyntheticSet("firm-ground", 3, seed, pga=7.0)[2]
    found = rk.assess(CABINET, motion, 0.92, count=8)
    assert found.lowest.factor < 1.0

    def margin(**change):
        body = changed(CABINET, **change)
        (pair,) = Landings(CABINET, {"one": 0.92}).of(body)
        return Margins.of(body, [motion], pair, "pga", None, {}).min_factors_by_polarity.min()

    assert margin(out=found.remedies.wider.length_no_overturning) > 1.0
    assert margin(down=found.remedies.lower.length_no_overturning) > 1.0
    monkeypatch.setattr(rocking.decision.remedies, "holds", lambda *_: True)  # negative control
    assert margin(out=remedies(CABINET, [motion], 1.0, g, {"one": 0.92}, falls=True).wider.length_no_overturning) < 0.95


def test_a_body_of_another_shape_keeps_its_coefficients():
    """A T is changed as a block of its mass and moments, with the T's own coefficients, and never said to stand."""
    stem = [(0.0, 0.0), (0.4, 0.0), (0.4, 1.6), (0.9, 1.6), (0.9, 2.0), (-0.3, 2.0), (-0.3, 1.6), (0.0, 1.6)]
    tee = rk.Section([rk.Region(stem, 700.0)])
    same, ked = changed(tee), rk.restitution.model("ked")
    landings = Landings(tee, {"ked": ked, "number": 0.8})
    for foot in ("left", "right"):
        own = ked.coefficient(tee, foot)
        assert [each[foot] for each in landings.of(same)] == pytest.approx([own, 0.8], rel=1e-12)
        assert abs(own - ked.coefficient(same, foot)) > 0.003  # negative control: the block's own
        wider = changed(tee, out=0.02)
        moved = ked.coefficient(wider, foot) - ked.coefficient(same, foot)
        assert landings.of(wider)[0][foot] == pytest.approx(own + moved, rel=1e-12)
    peak = 6.0 * 1.002 * rk.assess(tee, record(6.0), "ked", count=8).lowest.factor
    found = rk.assess(tee, record(peak), "ked", count=8)
    assert "overturns under 1 of 1 motion" in found.verdict
    assert "no history overturns" in found.measures[1]
    assert "unchanged body" not in str(found)


def test_what_is_demanded_is_never_rounded_down():
    """Every force, length and period in words holds at least what is computed, and less than a hundredth more."""
    for peak in (6.0, 6.3, 6.6, 6.9):
        found = rk.assess(CABINET, record(peak), [0.85], count=8)
        asked, said = found.remedies, [re.findall(r"[\d.]+(?= (?:kN|mm|s)\b)", words) for words in found.measures]
        anchors = [*asked.tension.values(), asked.shear]
        exact = [force / 1e3 for force in anchors]
        exact += [
            1e3 * getattr(each, name)
            for each in (asked.wider, asked.lower)
            for name in ("length_no_overturning", "length_no_uplift")
        ]
        exact += [asked.isolation[0], 1e3 * asked.isolation[1]]
        for words, value in zip(map(float, itertools.chain(*said)), filter(None, exact), strict=True):
            assert value * (1.0 - 1e-9) <= words < 1.01 * value + 1.0
    assert (rounded_up(12.34), rounded_up(12.3), rounded_up(0.0), millimetres(0.0031), millimetres(0.003)) == (
        pytest.approx(12.4), pytest.approx(12.3), 0.0, 4, 3,
    )  # fmt: skip


def test_more_margin_asks_for_more():
    """Remedies hold the factor that is asked for."""
    one, more = (rk.assess(CABINET, record(6.0), [0.85], count=16, margin=margin).remedies for margin in (1.0, 1.5))
    assert more.tension["left"] - one.tension["left"] == pytest.approx(0.5 * 650.0 * 6.0 * 0.9 / 0.8, rel=1e-3)
    assert more.shear == pytest.approx(1.5 * one.shear)
    assert more.wider.length_no_uplift > one.wider.length_no_uplift


def test_two_components_are_turned():
    """Two horizontal components make 12 motions of the plane, the vertical one beside each; a known azimuth one."""
    both = {"x": record(3.0), "y": record(4.0, 0.8), "z": record(1.0, 0.5)}
    plane, records = in_the_plane([both])
    assert records.tolist() == [0] * DIRECTIONS
    assert len(plane) == DIRECTIONS
    assert plane[0].peak == pytest.approx(both["x"].peak)
    assert max(each.peak for each in plane) == pytest.approx(5.0, rel=0.01)  # 3 and 4, within 15 degrees
    assert all(each.vertical is not None for each in plane)
    ((one,), _) = in_the_plane([both], azimuth=math.pi / 2.0)
    assert one.peak == pytest.approx(both["y"].peak)
    names = [each.name for each in in_the_plane([record(3.0), record(3.0)])[0]]
    assert names == ["sine of 3", "sine of 3 (no. 2)"]


def test_records_are_counted_not_their_directions():
    """Of one pair and one component two motions are counted, in verdict, models and code methods."""
    pair = {"x": record(9.0), "y": record(0.5)}
    found = rk.assess(CABINET, [pair, record(2.0)], ["ked", 0.85], count=8)
    assert [found.verdict.facts[name] for name in ("count", "with_all", "with_some")] == [1, 1, 1]
    assert found.overturning_fraction.tolist() == [1.0, 0.0]
    assert [found.count_overturned(each) for each in found.models.values()] == [1, 1]
    fell = np.array([each.overturned for each in found.models.values()]).max(axis=0)
    assert 1 < fell.sum() < DIRECTIONS  # negative control: directions are more, and some stand
    counted = [row for row in found.code_rows if row["overturned"] is not None]
    assert {row["safe"] for row in counted} <= {"0 of 1", "1 of 1", "0 of 2", "1 of 2", "2 of 2"}
    assert counted
    assert max(row["overturned"] for row in counted) <= 1
    assert "deg" in found.motions[found.lowest.motion].name


def test_the_calibrated_model_comes_with_its_interval():
    """All models are asked where none is named, the calibrated one at its mean and both ends."""
    named = choices(CABINET, None)
    middle = named["calibrated"].coefficient(CABINET, "right")
    assert named["calibrated, low"]["right"] < middle < named["calibrated, high"]["right"]
    assert set(rk.restitution.models()) - {"fixed"} <= {name.partition(":")[0] for name in named}
    assert choices(CABINET, [0.85]) == {"r = 0.85": 0.85}


def test_the_interval_is_that_of_predictions():
    """The calibrated model's ends are the quantiles of what `predict` draws from, onto each foot."""
    named = choices(CABINET, ["calibrated"])
    for foot in ("left", "right"):
        drawn = rk.evidence.restitution_distribution(CABINET, foot=foot).sample(200_000, 1)
        for end, level in (("low", 0.025), ("high", 0.975)):
            below = (drawn < named[f"calibrated, {end}"][foot]).mean()
            assert below == pytest.approx(level, abs=0.002)  # five deviations of a share of 200 000 draws


def test_one_restitution_needs_no_list():
    """A name, a number and a model are taken as a list of one."""
    for one in ("ked", 0.9, rk.restitution.Housner()):
        assert list(rk.assess(CABINET, record(2.0), one, count=8).models) == list(choices(CABINET, [one]))


def test_no_history_with_a_result(monkeypatch):
    """Where no history has a result nothing is said but that: no margin, no remedy that would rest on histories."""
    unknown = SimpleNamespace(
        overturned_by_polarity=np.full((2, 1, 1), np.nan), min_factors_by_polarity=np.full((2, 1), np.nan)
    )
    unknown.overturned = unknown.overturned_by_polarity[0]
    monkeypatch.setattr(Margins, "of", lambda *_: unknown)
    found = rk.assess(CABINET, record(6.0), [0.9], count=8)
    assert found.verdict == "No history has a result; overturning cannot be assessed."
    assert found.margin_sentence == "Margin to overturning: not available."
    assert not any("overturns" in words for words in (*found.measures, *found.governing_factors))


def test_what_makes_no_sense_is_refused():
    """What is no body, a motion that is zero, a margin of zero, an unknown model."""
    with pytest.raises(InvalidValueError, match="MassPoints or Solid"):
        rk.assess("cabinet", record(3.0))
    with pytest.raises(InvalidValueError, match="zero throughout"):
        rk.assess(CABINET, rk.GroundMotion([0.0, 0.0], 0.01))
    with pytest.raises(InvalidValueError, match="margin must be"):
        rk.assess(CABINET, record(3.0), margin=0.0)
    with pytest.raises(InvalidValueError, match=r"margin must be in \(0, 50\], got 1e\+09"):
        rk.assess(CABINET, record(3.0), margin=1e9)
    with pytest.raises(rk.errors.UnknownModelError):
        rk.assess(CABINET, record(3.0), ["nobody"])


def test_what_governs_agrees_with_its_figures():
    """Equal margins are not said to move; uplift with vertical motion is not that without; overlapping indices."""
    time = np.arange(0.0, 1.6, 0.01)
    level, up = 6.0 * np.sin(2.0 * math.pi * time / 0.8), np.full(time.size, -2.0)
    found = rk.assess(CABINET, rk.GroundMotion(level, 0.01, up, name="both"), ["ked", "housner"], count=16)
    lifts = 0.28 * g / (0.9 * 6.0 + 0.28 * 2.0)  # k 6 h = (g - k 2) b, the weaker side
    assert found.uplift_factors[0] == pytest.approx(lifts, rel=2e-3)  # the largest sample is below 6 m/s2
    assert f"Without vertical acceleration, uplift begins at {0.28 / 0.9:.3g} g" in found.governing_factors[0]
    along = rk.assess(CABINET, rk.GroundMotion(level, 0.01, name="both"), ["ked", "housner"], count=16)
    assert f"Uplift begins at {0.28 / 0.9:.3g} g, at " in along.governing_factors[0]
    low, high = (f(each.min_factor for each in along.models.values()) for f in (min, max))
    assert (f"{low:.3g}" == f"{high:.3g}") == ("depending on" not in " ".join(along.governing_factors))
    shares = along.prediction.contributions
    if any(share.total > 0.0 for share in shares.values()):
        most = max(shares.values(), key=lambda share: share.total)
        apart = most.total_low > max(each.total_high for each in shares.values() if each is not most)
        assert ("Main uncertainty" in along.governing_factors[-1]) == apart
        assert ("distinguishable" in along.governing_factors[-1]) != apart


def test_cases_count_models_coefficients_and_interval_ends():
    """The number of restitution cases, and the models, coefficients and interval ends among them."""
    names = choices(CABINET, ["calibrated", "ked", 0.9])
    facts = _cases(names).facts
    assert facts["count"] == len(names) == 5
    assert "2 models, 1 coefficient, 2 ends" in facts["parts"]
    assert _cases(["ked"]).facts["parts"] == "1 model"


def test_a_depth_that_is_the_weaker_side_is_a_caution():
    """The verdict of the width has a caution with both limits of uplift; exchanged dimensions have none."""
    pulse = rk.pulses.sine(3.6, 0.8)
    assessment = rk.assess(rk.Block(width=0.8, height=2.0, depth=0.5), pulse, ["ked", 0.9], count=8)
    exchanged = rk.assess(rk.Block(width=0.5, height=2.0, depth=0.8), pulse, ["ked", 0.9], count=8)
    assert assessment.lowest.factor > 1.0 > exchanged.lowest.factor
    facts = assessment.body.depth_note.facts
    assert (facts["limit"], facts["own"]) == pytest.approx((0.25, 0.4), rel=1e-12)
    answer = assessment.answer()
    assert answer["verdict"].endswith(answer["caution"])
    assert assessment.prediction.sentences[1] == answer["caution"]
    assert "caution" not in exchanged.answer().values
    assert exchanged.body.caution == ""
