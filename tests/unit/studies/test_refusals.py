"""What studies refuse: every argument outside its range, by its name, before anything is computed."""

import math
from functools import partial

import numpy as np
import pytest

import rocking as rk
from rocking.decision.inventory import InventoryObject
from rocking.decision.inventory.hazard import Hazard
from rocking.errors import InvalidValueError, RockingError
from rocking.motions import measure
from rocking.studies import (
    HistoryTable,
    MotionList,
    Product,
    SyntheticSet,
    boundary,
    fragility_analysis,
    minimum_overturning_acceleration,
    minimum_overturning_accelerations,
    overturning_map,
    rocking_spectrum,
)
from rocking.studies.fragility.limit_states import limit_states_of
from rocking.studies.fragility.subject import checked_levels
from rocking.studies.sensitivity.restitutions import named_restitutions

BLOCK = rk.Block(width=0.4, height=1.6)
SINE = rk.pulses.sine(3.0, 0.6)
RECORD = rk.GroundMotion([0.0, 1.0, -3.0, 0.0], 0.1)
STILL = rk.GroundMotion([0.0, 0.0], 0.1)
LEVELS = [2.0, 4.0, 6.0, 8.0]
OF_BODY = {"body": BLOCK, "motion": SINE, "restitution": 0.9}
OF_MOTIONS = {"body": BLOCK, "motions": [SINE], "levels": [2.0, 4.0]}

minimum = partial(minimum_overturning_acceleration, **OF_BODY)
mapped = partial(overturning_map, x=("scale", [1.0, 2.0]), y=("period", [0.3, 0.6]), **OF_BODY)
outlined = partial(boundary, x=("frequency_ratio", [1.0, 2.0]), y=("amplitude_ratio", [1.0, 2.0]), **OF_BODY)
spectrum = partial(rocking_spectrum, motions=[SINE], slenderness_angles=[0.2], periods=[1.0, 2.0], restitution=0.9)
stripes = partial(fragility_analysis, **OF_MOTIONS)
incremental = partial(stripes, analysis="incremental")
curves = partial(rk.fragility, body=BLOCK, motions=[SINE])


def listed(motions, **words):
    """An inventory of one vase."""
    return rk.inventory([InventoryObject(name="vase", width=0.12, depth=0.24, height=1.0)], motions, **words)


def synthetic(which="firm-ground", count=3, seed=1, **options):
    """A synthetic set."""
    return SyntheticSet(which, count, seed, **options)


def product(sides=None, scales=(1.0, 2.0), motions=5):
    """Histories of one body."""
    names = ("alpha", "p", "r", "q")
    every = {f"{name}_{side}": np.full((1, 1), 0.2) for name in names for side in ("right", "left")}
    return Product(MotionList([SINE] * motions), every if sides is None else sides(every), np.array(scales))


REFUSED = [
    # what is asked, with what, and the words of the refusal
    *[(minimum, {name: value}, words) for name, value, words in (
        ("samples", 1, "samples"), ("samples", 2.0, "samples"), ("bisections", 13, "bisections"),
        ("min_pga", 0.0, "min_pga"),
        ("highest", math.inf, "highest"), ("tolerance", -1.0, "tolerance"), ("body", None, "body"),
        ("motion", 3, "motion"), ("motion", STILL, "peak above zero"),
    )],
    (minimum, {"min_pga": 9.0, "max_pga": 8.0}, "below max_pga"),
    *[(minimum_overturning_accelerations, {"bodies": bad, "motion": SINE}, "bod") for bad in ([], BLOCK, "block", 3)],
    *[(mapped, {name: value}, name) for name, value in (
        ("motion", 3.0), ("body", "block"), ("gravity", -1.0), ("nonsense", 1), ("threads", 0), ("progress", 3),
        ("engine", "slow"),
    )],
    (mapped, {"restitution": 1.2}, "energy"),
    *[(mapped, {"refine": bad}, "levels") for bad in (-1, 13, 1.5, True, "2")],
    (outlined, {"by": "side"}, "by"), (outlined, {"tolerance": 0.0}, "tolerance"), (outlined, {"levels": -1}, "levels"),
    (outlined, {"x": ("frequency_ratio", [1.0])}, "at least 2"), (outlined, {"restitution": 2.0}, "energy"),
    *[(spectrum, {name: value}, name) for name, value in (
        ("slenderness_angles", [-0.1]), ("periods", [0.0]), ("periods", [np.nan]), ("periods", []),
        ("periods", [[1.0]]), ("motions", []), ("motions", [SINE, RECORD]), ("scale", math.inf), ("nonsense", 1),
    )],
    (spectrum, {"slenderness_angles": [0.1, 2.0]}, "slenderness_angle"), (spectrum, {"restitution": 1.5}, "energy"),
    *[(stripes, change, None) for change in (
        {"levels": []}, {"levels": [[1.0, 2.0], [3.0, 4.0]]}, {"levels": [2.0, 1.0]}, {"levels": [1.0, math.nan]},
        {"levels": [0.0, 1.0]}, {"measure": "x"}, {"measure": "pgv/pga"}, {"states": (0.5, 0.1)}, {"motions": []},
        {"body": "block"}, {"restitution": 2.0}, {"progress": 3}, {"threads": 0}, {"gravity": -1.0},
        {"engine": "slow"}, {"nonsense": 1},
    )],
    *[(incremental, change, None) for change in (
        {"tolerance": -1.0}, {"tolerance": 1.0}, {"levels": [3.0, 2.0]}, {"measure": "d5_95"},
    )],
    (curves, {"analysis": "ida"}, "analysis must be one of stripes, cloud, incremental"),
    (curves, {"analysis": "cloud", "levels": LEVELS}, "A cloud uses the motions as recorded"),
    (curves, {"scale": 2.0}, 'scale is for analysis="cloud" only, this is "stripes"'),
    (curves, {"analysis": "cloud", "tolerance": 0.1}, 'tolerance is for analysis="incremental" only'),
    (curves, {"im": "arias"}, "levels of arias are missing"),
    (curves, {"limit_states": (0.5, 0.2)}, "limit_states must increase from value to value; reverse the order"),
    (listed, {"motions": "firm-ground"}, "The intensity level is missing"),
    (listed, {"motions": "firm-ground", "pga": "0.3g", "pgv": 0.2}, "pga or pgv, not both"),
    (listed, {"motions": [RECORD], "count": 3}, "count applies to synthetic motions only"),
    (listed, {"motions": Hazard.of_records([RECORD]), "pga": 1.0}, "already scaled"),
    (listed, {"motions": [RECORD], "pga": "0.3"}, "PGA must be a number with its unit"),
    (listed, {"motions": [RECORD], "pga": True}, "PGA must be a number with its unit"),
    *[(checked_levels, {"name": "levels", "values": bad, "unit": "m/s2"}, "levels must (be|increase)") for bad in (
        [], [1.5, 1.5], [3.0, 1.5], [0.0, 1.0], [[1.5, 3.0], [4.5, 6.0]], [[1.5], [3.0]],
    )],
    *[(limit_states_of, {"levels": bad}, None) for bad in (
        (0.5, 0.2), (0.0,), (-1.0,), (math.nan,), (math.inf,), (0.5, 0.5), "half", [[0.1], [0.2]],
    )],
    (synthetic, {"count": 0}, r"count must be a whole number in \[1"),
    (synthetic, {"count": 2.5}, "count must be a whole number"),
    (synthetic, {"seed": -1}, "seed must be a whole number"),
    (synthetic, {"which": "no-such"}, "family must be one of"),
    (synthetic, {"pga": 0.0}, "pga must be > 0"),
    (synthetic, {"pga": math.nan}, "pga must be finite"),
    (synthetic, {"pgv": -1.0}, "pgv must be > 0"),
    (synthetic, {"pga": 1.0, "pgv": 1.0}, "not to both"),
    (synthetic, {"time_step": 0.0}, "time_step must be > 0"),
    (MotionList, {"motions": []}, "got none"),
    (MotionList, {"motions": [RECORD, SINE]}, "all records or all pulses"),
    (MotionList, {"motions": [RECORD, 3.0]}, "at index 1"),
    (product, {"sides": lambda every: {**every, "p_left": np.ones((1, 2))}}, "sides must be"),
    (product, {"sides": lambda every: {"p_left": every["p_left"]}}, "sides must be"),
    (product, {"scales": np.ones((4, 2))}, "scales must be"),
    (partial(HistoryTable, MotionList([SINE]), np.zeros(3)), {"values": {"p": np.ones(3)}}, "missing or unknown"),
    *[(product().run, {"first": first, "last": last}, r"within \[0, 10\]") for first, last in (
        (-1, 3), (4, 3), (0, 11),
    )],
    *[(measure, {"name": bad}, None) for bad in (
        "pgaa", "sa", "sa()", "sa(-1)", "sa(1,2,3)", None, 3, "sa(nan)", "sa(0.0)",
    )],
    (measure("pgv/pga").factors, {"values": np.ones(2), "targets": np.ones(2)}, "must grow with"),
    *[(named_restitutions, {"restitutions": bad}, words) for bad, words in (
        (["ked"], "at least two"), (["ked", "ked"], "'ked'"), ("ked", "list or a dict"), (0.9, "list or a dict"),
        ({"left": 0.8, "right": 0.9}, "is one restitution"), (["ked", {"left": 0.9}], "by side"),
        (["ked", object()], "number"), (["ked", float("nan")], "finite"),
    )],
]  # fmt: skip


@pytest.mark.parametrize(("asked", "change", "words"), REFUSED)
def test_what_is_refused(asked, change, words):
    """Nothing outside its range becomes a number: the sentence names what was wrong."""
    with pytest.raises(InvalidValueError, match=words):
        asked(**change)


def test_what_looks_alike_is_taken():
    """A single level is a row of one; a pulse alone is a list; names of models that are unknown are refused as such."""
    assert checked_levels("levels", 1.5, "m/s2").tolist() == [1.5]
    assert checked_levels("levels", (1.5, 1.6, 6.0), "m/s2").tolist() == [1.5, 1.6, 6.0]
    assert MotionList(SINE)[0] is SINE
    with pytest.raises(RockingError, match="unknown restitution model"):
        named_restitutions({"a": "ked", "b": "nonsense"})
