"""Verdicts: closed forms for uplift and overturning, counts made by hand, rows that do not touch one another."""

import csv
import io
import json
import math
import re
import tracemalloc

import numpy as np
import pytest

from rocking.decision.inventory import InventoryObject, Thresholds, assess, parse_inventory, ranking
from rocking.decision.inventory import assessment as module
from rocking.decision.inventory.hazard import Hazard, IntensityLevel
from rocking.decision.inventory.lights import Light
from rocking.decision.inventory.ranking import COLUMNS, answer_of, as_csv, rows
from rocking.dynamics import RandomRestitution
from rocking.errors import InvalidValueError, UnknownModelError
from rocking.motions import GroundMotion
from rocking.outcome import Outcome
from rocking.tables import escaped

pytestmark = [pytest.mark.slow, pytest.mark.verifies(room="studies")]

G = 9.80665
# tan alpha = 1/4 along the width, 1/2 along the depth
COLUMN = InventoryObject(name="column", width=0.5, depth=1.0, height=2.0)
# p of a block: sqrt(3 g / (4 R)), R = sqrt(0.25^2 + 1)
P = math.sqrt(3.0 * G / (4.0 * math.hypot(0.25, 1.0)))
# a rectangular pulse of 2 g tan(alpha) overturns from p t = 0.69465741849470975 on (exact nonlinear integral)
CRITICAL = 0.69465741849470975 / P


def rectangle(duration, acceleration=0.5 * G):
    """A constant acceleration, twice that of uplift along the width and just not beyond it along the depth."""
    return GroundMotion([acceleration, acceleration], duration)


@pytest.fixture(scope="module")
def quakes():
    """Synthetic motions at PGA 0.3 g."""
    return Hazard.of_family("point-source", IntensityLevel.of("PGA", "0.3g"), count=60, seed=3)


@pytest.mark.verifies("closed form", "the rectangle that just overturns, 0.01 shorter and longer")
def test_a_count_of_numpy_is_a_number():
    """It is written into JSON as any other."""
    assert type(InventoryObject(name="vase", width=0.2, depth=0.2, height=1.0, count=np.int64(3)).count) is int


def test_counts_by_hand():
    """Pulses 1 % shorter than the closed form for overturning leave it standing, 1 % longer do not: 3 of 10 fall."""
    hazard = Hazard.of_records([rectangle(0.99 * CRITICAL)] * 7 + [rectangle(1.01 * CRITICAL)] * 3)
    (verdict,) = (found := assess([COLUMN], hazard)).verdicts
    wide = {each.direction: each for each in verdict.results}["width"]
    assert (wide.count, wide.lifted, wide.overturned, wide.failed) == (10, 10, 3, 0)
    assert verdict.worse is wide
    assert wide.high_rotation is None
    assert wide.median_rotation > 0.5
    assert (verdict.light, wide.overturned_fraction) == (Light.RED, 0.3)
    # Clopper & Pearson for 3 of 10, as tables print it
    assert verdict.interval == pytest.approx((0.0667, 0.6525), abs=5e-5)
    assert ranking.sentence(verdict, found) == (
        "No uplift below 0.25 g; at PGA 0.5 g it rocks, and overturns in 3 of 10 records."
    )
    # b / h = a / g along the width needs a base of 0.5 m * 2
    assert "its width is 50 cm; 101 cm prevent uplift" in ranking.advice(verdict, found)  # 100 cm is the limit itself


def test_the_median_of_two_motions_is_their_mean():
    """Quantiles of two are linear between both peaks; where one of two overturns, the median overturns."""

    def rotations(*lengths):
        (verdict,) = assess([COLUMN], Hazard.of_records([rectangle(each * CRITICAL) for each in lengths])).verdicts
        wide = next(each for each in verdict.results if each.direction == "width")
        return wide.median_rotation, wide.high_rotation

    (low, _), (high, _) = rotations(0.7), rotations(0.9)
    assert high > 1.2 * low
    assert rotations(0.7, 0.9) == pytest.approx((0.5 * (low + high), low + 0.84 * (high - low)), rel=1e-12)
    assert rotations(0.7, 1.1) == (None, None)
    assert rotations(0.7, 0.9, 1.1)[0] == pytest.approx(high, rel=1e-12)


@pytest.mark.verifies("closed form", "g b / h", within="1e-6 on either side")
@pytest.mark.parametrize("way", ["width", "depth"])
def test_uplift_is_sharp(way):
    """A millionth below g b / h no motion lifts the object, a millionth above every one does."""
    limit = COLUMN.uplift_acceleration(way)
    shape = np.sin(np.linspace(0.0, 6.0 * np.pi, 601))
    for factor, lifted in ((1.0 - 1e-6, 0), (1.0 + 1e-6, 1)):
        hazard = Hazard.of_records([GroundMotion(shape, 0.01)], IntensityLevel("PGA", factor * limit))
        (verdict,) = assess([COLUMN], hazard).verdicts
        assert {each.direction: each.lifted for each in verdict.results}[way] == lifted
    assert limit == pytest.approx(G * {"width": 0.25, "depth": 0.5}[way], rel=1e-14, abs=0.0)


def test_what_is_never_lifted_is_green():
    """Below g b / h: no lift, no rotation, green with a single motion, and the words say so."""
    hazard = Hazard.of_records([rectangle(1.0, 0.24 * G)])
    (verdict,) = (found := assess([COLUMN], hazard)).verdicts
    assert (verdict.light, verdict.worse.lifted, verdict.worse.high_rotation) == (Light.GREEN, 0, 0.0)
    assert ranking.sentence(verdict, found).endswith("at PGA 0.24 g no uplift in the one record.")
    assert ranking.advice(verdict, found).startswith("No measure")


def test_share_lifted_grows_with_the_level(quakes):
    """At every PGV the share lifted is the share of motions whose PGA passes g b / h, which cannot fall with PGV."""
    shares = []
    for level in (0.1, 0.2, 0.3, 0.6):
        hazard = Hazard.of_family("point-source", IntensityLevel("PGV", level), count=30, seed=1)
        (verdict,) = assess([COLUMN], hazard).verdicts
        for each in verdict.results:
            assert each.lifted == sum(motion.peak > each.uplift_acceleration for motion in hazard.motions)
        shares.append(verdict.results[0].lifted_fraction)
    assert shares == sorted(shares)
    assert 0.0 < shares[2] < 1.0


def test_worse_direction_governs(quakes):
    """Width and depth exchanged exchange the results and leave the verdict."""
    turned = InventoryObject(name="turned", width=1.0, depth=0.5, height=2.0)
    one, two = (assess([item], quakes).verdicts[0] for item in (COLUMN, turned))
    assert (one.worse.direction, two.worse.direction) == ("width", "depth")
    assert one.worse.overturned == two.worse.overturned
    assert one.results[1].high_rotation == two.results[0].high_rotation


def test_larger_of_two_alike_stands_better(quakes):
    """Of equal slenderness, the smaller overturns more often: Housner's scale effect, and the ranking shows it."""
    small, large = (
        InventoryObject(name=name, width=0.2 * size, depth=0.2 * size, height=size)
        for name, size in (("small", 1.0), ("large", 5.0))
    )
    found = assess([large, small], quakes)
    assert [each.item.name for each in found.verdicts] == ["small", "large"]
    assert found.verdicts[0].worse.overturned > found.verdicts[1].worse.overturned
    severities = [each.worse.severity for each in found.verdicts]
    assert severities == sorted(severities, reverse=True)


def test_bad_rows_touch_no_other(quakes):
    """With a bad row between, the verdict of a good one is the same to the last bit."""
    head = "name,width_cm,depth_cm,height_cm\n"
    alone = assess(parse_inventory(head + "vase,20,20,90"), quakes)
    mixed = assess(parse_inventory(head + "bad,?,20,90\nvase,20,20,90\nworse,20,20"), quakes)
    assert mixed.verdicts[0].results == alone.verdicts[0].results
    assert [(each.row, each.name) for each in mixed.not_assessed] == [(2, "bad"), (4, "worse")]
    nothing = assess(parse_inventory(head + "bad,?,20,90"), quakes)
    assert (nothing.verdicts, len(nothing.not_assessed), nothing.counts()[Light.RED]) == ((), 1, 0)


def test_model_of_impact_is_flagged(quakes):
    """Without any loss at impacts more objects fall than by Housner; where the light differs, it is said."""
    items = [InventoryObject(name=f"{cm} cm", width=0.01 * cm, depth=2.0, height=1.8) for cm in range(36, 54, 2)]
    found = assess(items, quakes, restitution=1.0)
    assert found.comparisons == ("housner",)
    assert sum(v.worse.overturned for v in found.verdicts) > sum(v.worse_compared[0].overturned for v in found.verdicts)
    flagged = [verdict for verdict in found.verdicts if verdict.depends_on_model]
    assert flagged
    for verdict in found.verdicts:
        note = ranking.model_note(verdict, found)
        assert bool(note) == (any(each.light is not verdict.light for each in verdict.worse_compared))
    assert ranking.model_note(flagged[0], found).startswith(
        "The rating depends on the restitution model: housner gives"
    )
    assert assess(items[:1], quakes, restitution="housner").comparisons == ("ked",)
    usual = assess(items[:1], quakes)
    assert (usual.restitution, usual.comparisons) == ("calibrated", ("housner", "ked"))
    asked = [assess(items[:1], quakes, restitution=name).verdicts[0].results for name in usual.comparisons]
    assert list(usual.verdicts[0].compared) == asked


def test_failed_motions_are_said_and_forbid_green(monkeypatch, quakes):
    """Where a motion could not be computed it is not counted as standing; where none could, there is no verdict."""
    original = module.results_of

    def broken(product, **how):
        results = original(product, **how)
        outcome, peak = (results[name].reshape(60, 4, 3) for name in ("outcome", "peak_rotation"))
        outcome[0, :2], peak[0, :2] = Outcome.FAILED.code, np.nan
        outcome[:, 2:] = Outcome.FAILED.code
        return results

    monkeypatch.setattr(module, "results_of", broken)
    chest = InventoryObject(name="chest", width=2.0, depth=2.0, height=0.5)
    found = assess([chest, COLUMN], quakes)
    (verdict,) = found.verdicts
    assert (verdict.light, verdict.worse.failed, verdict.worse.count) == (Light.AMBER, 1, 59)
    assert "1 of 60 motions could not be computed" in ranking.sentence(verdict, found)
    assert "no motion could be computed" in str(found.not_assessed[0].reason)
    json.dumps(answer_of(found).plain(), allow_nan=False)


def test_progress_and_threads(quakes):
    """The progress adds up to all histories: motions x objects x 2 directions x 3 models; threads change nothing."""
    told = []
    one = assess([COLUMN, COLUMN], quakes, progress=told.append, threads=1)
    assert sum(told) == 60 * 2 * 2 * 3
    assert one.verdicts[0].results == assess([COLUMN], quakes, threads=2).verdicts[0].results


def test_refusals(quakes):
    """No objects, a law of impacts, an unknown model: refused as a whole, since no row is at fault."""
    with pytest.raises(InvalidValueError, match="at least one object"):
        assess([], quakes)
    with pytest.raises(UnknownModelError):
        assess([COLUMN], quakes, restitution="no-such")
    with pytest.raises(InvalidValueError, match="restitution must be in"):
        assess([COLUMN], quakes, restitution=-0.5)
    with pytest.raises(InvalidValueError, match="not an impact law"):
        assess([COLUMN], quakes, restitution=RandomRestitution([0.9, 1.0], times="ked", seed=1))


def test_thresholds_of_ones_own(quakes):
    """A stricter threshold turns amber into red and is what the plain values say."""
    item = InventoryObject(name="case", width=0.45, depth=2.0, height=1.8)
    usual = assess([item], quakes, restitution="ked")
    strict = assess([item], quakes, restitution="ked", thresholds=Thresholds(0.2, 0.001, 0.002))
    assert usual.verdicts[0].light is Light.AMBER
    assert strict.verdicts[0].light is Light.RED
    assert answer_of(strict).plain()["thresholds"]["overturning_red"] == 0.002


@pytest.mark.parametrize("text", ["=1+1", "+1", "-1", "@cmd", "\t=1", " =1", "\r=1"])
def test_no_cell_is_a_formula(text, quakes):
    """Names and notes that a spreadsheet would run have an apostrophe before them, in good rows and bad ones."""
    assert escaped(text) == "'" + text
    good = InventoryObject(name=text, width=0.5, depth=1.0, height=2.0, note=text)
    lines = rows(assess([good], quakes))
    assert lines[0][COLUMNS.index("name")] == lines[0][COLUMNS.index("note")] == "'" + text
    bad = parse_inventory(f'name,width_cm,depth_cm,height_cm,note\n"{text}",?,1,1,x')
    for line in rows(assess(bad, quakes)):
        assert not any(isinstance(cell, str) and cell.lstrip(" ").startswith(("=", "+", "-", "@")) for cell in line)
    # negative control: words without such a beginning stay as they are
    assert escaped("vase = 3") == "vase = 3"


def test_table_and_plain_values_agree(quakes):
    """CSV, its rows and the JSON say the same of every object, the worst first, and of rows without a verdict."""
    text = "name,width_cm,depth_cm,height_cm\nvase,20,20,90\nchest,200,200,50\nbad,?,1,1"
    found = assess(parse_inventory(text), quakes)
    lines = list(csv.DictReader(io.StringIO(as_csv(found))))
    plain = json.loads(json.dumps(answer_of(found).plain(), allow_nan=False))
    assert [line["name"] for line in lines] == ["vase", "chest", "bad"]
    for line, item in zip(lines[:2], plain["objects"], strict=True):
        worse = next(each for each in item["directions"] if each["direction"] == item["worse_direction"])
        assert int(line["overturned"]) == worse["overturned"]
        assert float(line["overturned, high [%]"]) == pytest.approx(100.0 * item["overturned_interval"][1], abs=0.005)
        assert float(line["uplift acceleration [g]"]) == pytest.approx(item["uplift_acceleration"] / G, abs=5e-5)
        assert line["description"] == item["text"]
    assert lines[2]["description"].startswith("not assessed: width_cm is '?'")
    assert plain["counts"] == {"red": 1, "amber": 0, "green": 1, "not_assessed": 1}
    assert plain["hazard"]["number_of_motions"] == 60
    assert any("Sliding is not assessed" in each for each in plain["assumptions"])


def test_the_range_of_velocities_is_not_overwritten(quakes):
    """JSON gives the range of the motions' own velocities beside the level asked for, under names of their own."""
    plain = answer_of(assess([COLUMN], quakes)).plain()["hazard"]
    own = [np.abs(motion.time_step * np.cumsum(motion.acceleration)).max() for motion in quakes.motions]
    # a running sum instead of trapezoids
    assert plain["pgv_range"] == pytest.approx([min(own), max(own)], rel=0.05)
    assert (plain["pga"], plain["pgv"]) == (pytest.approx(0.3 * G), None)
    scaled = Hazard.of_family("point-source", IntensityLevel.of("PGV", "15cm/s"), count=3, seed=1)
    plain = answer_of(assess([COLUMN], scaled)).plain()["hazard"]
    assert plain["pgv"] == 0.15
    assert plain["pgv_range"] == pytest.approx([0.15, 0.15], rel=1e-9)


def test_advice_does_not_call_a_base_a_width(quakes):
    """Where the base is narrower than the body, it is the base that is 8 cm; where it is not, the width is."""
    objects = [InventoryObject(name="urn", width=0.3, depth=0.4, height=1.0, base_width=0.08, base_depth=0.3)]
    objects.append(InventoryObject(name="stele", width=0.08, depth=0.4, height=1.0))
    told = {v.item.name: ranking.advice(v, found) for found in [assess(objects, quakes)] for v in found.verdicts}
    assert "its base is 8 cm along the width; " in told["urn"]
    assert "its width is 8 cm; " in told["stele"]


LISTED = [
    InventoryObject(name=f"{k}", width=0.1 + 0.01 * (k % 17), depth=0.2, height=0.5 + 0.02 * (k % 13), row=k)
    for k in range(40)
]


def test_blocks_of_objects_change_nothing(quakes, monkeypatch):
    """In blocks of one, of a few or of all objects every verdict and the progress are the same."""
    told = []
    whole = assess(LISTED, quakes, progress=told.append)
    assert sum(told) == 40 * 60 * 2 * 3
    for piece in (100, 1000, 60 * 6 * 7):
        monkeypatch.setattr(module, "PIECE", piece)
        told.clear()
        found = assess(LISTED, quakes, progress=told.append)
        assert found.verdicts == whole.verdicts
        assert max(told) <= max(piece, 60 * 2 * 3)  # of one object at least
        assert sum(told) == 40 * 60 * 2 * 3


def test_memory_does_not_grow_with_the_inventory(monkeypatch):
    """Eight times as many objects need less than twice the memory beyond what their verdicts take.

    The motions are short, so that the histories of an object need more memory than they. Negative control: in one piece
    the memory grows.
    """
    pulse = 4.0 * np.sin(np.linspace(0.0, 6.0 * np.pi, 61))
    hazard = Hazard.of_records([GroundMotion(pulse, 0.01 * (1 + k % 20)) for k in range(60)])

    def needed(count, objects_at_once):
        monkeypatch.setattr(module, "PIECE", 60 * 2 * 3 * objects_at_once)
        tracemalloc.start()
        found = assess(LISTED[:count], hazard, threads=1)
        kept, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert len(found.verdicts) == count
        assert found.plan, "measures are computed in pieces too"
        return most - kept

    needed(5, 5)  # what is made once is made here
    few = needed(5, 5)
    assert needed(40, 5) < 2.0 * few
    assert needed(40, 40) > 2.0 * few


@pytest.mark.verifies("invariant", "a round object with and without a friction; a box with one moves in space")
def test_a_round_object_with_friction_rocks_in_a_plane(quakes):
    """Its verdict is that without friction, which the answer says; a box with one is computed in three dimensions."""
    round_one = InventoryObject(name="drum", width=0.4, depth=0.4, height=1.4, shape="round")
    few = Hazard.of_records(quakes.motions[:4])
    (alone,) = assess([round_one], few).verdicts
    found = assess([round_one, COLUMN], few, friction=0.5)
    by_name = {each.item.name: each for each in found.verdicts}
    assert by_name["drum"].results == alone.results
    assert by_name["drum"].friction == math.inf
    assert tuple(map(str, by_name["drum"].item.remarks)) == (
        "the friction coefficient is ignored: a round object rocks in a plane without sliding",
    )
    assert (by_name["column"].friction, by_name["column"].item.remarks, alone.item.remarks) == (0.5, (), ())


@pytest.mark.verifies("invariant", "a box that lifts at the peak acceleration exactly, and its plan made true")
def test_a_plan_that_ends_where_it_just_lifts(quakes):
    """Where b/h is the peak to the last digit after the change, the plan goes on by a step, and its object is green."""
    box = InventoryObject(name="box", width=0.3, depth=0.3, height=1.2)
    few = Hazard.of_records(quakes.motions[:20])
    found = assess([box], few)
    (entry,) = found.plan
    assert entry.wider is not None
    wider = InventoryObject(name="wider", width=0.3 + 2.0 * entry.wider, depth=0.3 + 2.0 * entry.wider, height=1.2)
    assert assess([wider], few).verdicts[0].light is Light.GREEN
    needed = int(re.search(r"; (\d+) cm prevent uplift", ranking.advice(found.verdicts[0], found))[1])
    still = InventoryObject(name="still", width=needed / 100.0, depth=needed / 100.0, height=1.2)
    assert assess([still], few).verdicts[0].worse.lifted == 0
