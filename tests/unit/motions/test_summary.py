"""The statement of a motion: its support, intensity, source and steps, of one motion, of components and of several."""

import hashlib

import numpy as np
import pytest

import rocking as rk
from rocking.motions.components import Components
from rocking.motions.pipeline import processed
from rocking.motions.summary import (
    MotionSummary,
    condition,
    peak_name,
    provenance_of,
    provenance_rows,
    short_provenance,
    summaries_of,
)

pytestmark = pytest.mark.verifies("behaviour", room="motions and records")
FLOOR = "floor:number=3,storeys=5,period=0.5"


def record(scale=1.0, name="a"):
    return rk.GroundMotion(scale * np.sin(0.1 * np.arange(200.0)), 0.01, name=name, provenance=(f"made of {name}",))


def test_every_step_and_the_floor_stand_in_the_summary():
    """The summary contains each processing step, and the floor as the support."""
    found = MotionSummary.of(processed(record(), f"mean; bandpass:low=0.2,high=20; {FLOOR}; scale:pga=2"))
    assert found.support == "floor 3 of 5"
    assert found.name == "a, floor 3 of 5"
    said = " | ".join(found.provenance)
    for words in ("made of a", "mean acceleration removed", "band-pass 0.2 to 20 Hz", "fundamental period 0.5 s",
                  "5 % damping of every mode (assumed)", "PGA is 2 m/s2"):  # fmt: skip
        assert words in said
    # negative control: the motion of the ground has none of these
    ground = MotionSummary.of(record())
    assert (ground.support, ground.provenance) == ("ground", ("made of a",))


@pytest.mark.verifies("closed form", "the velocity of a sine from rest, 2 A / omega", within="1e-6")
def test_intensity():
    """PGA and PGV of a sine pulse are those of the closed form."""
    found = MotionSummary.of(rk.pulses.sine(amplitude=3.0, period=0.8))
    assert found.peak == 3.0
    assert found.peak_velocity == pytest.approx(2.0 * 3.0 * 0.8 / (2.0 * np.pi), rel=1e-6)


def test_the_condition_has_median_and_range():
    """The condition of a probability has median and range of PGA and PGV."""
    found = summaries_of([record(scale * rk.conventions.g) for scale in (0.1, 0.2, 0.4, 0.8)])
    words = condition(found)
    assert words.startswith("given these 4 motions (PGA 0.3 g, 0.1 to 0.8 g; PGV ")
    assert "PFA" in condition([MotionSummary.of(processed(record(), FLOOR))])
    assert (peak_name("ground"), peak_name("floor 1 of 2", "V")) == ("PGA", "PFV")


def test_what_is_shared_stands_once():
    """A step that all motions share is written once."""
    found = summaries_of([processed(record(name=name), FLOOR) for name in "abc"])
    rows = provenance_rows(found)
    assert [name for name, _ in rows] == [*(f"{name}, floor 3 of 5" for name in "abc"), "all 3 motions"]
    assert rows[0][1] == "made of a"
    assert rows[-1][1].startswith("floor 3 of 5 of an elastic shear building")


def test_no_motion_has_no_source():
    """Free rocking has no motion, so that its answer has no row of a source."""
    assert provenance_rows([]) == short_provenance([]) == []
    assert len(provenance_rows([MotionSummary.of(record())])) == 1  # negative control


def test_components_say_what_differs_by_axis():
    """Steps that differ between components are written by axis."""
    both = processed(Components(record(name="ns"), record(name="ew"), None), FLOOR)
    said = provenance_of(both)
    assert said[:2] == ("x: made of ns", "y: made of ew")
    assert said[2].startswith("floor 3 of 5")
    assert len(said) == 3


def test_many_records_show_their_files():
    """Of many records the files are listed."""
    several = [rk.GroundMotion([0.0, 1.0], 0.1, name=f"r{k}", provenance=(f"read from r{k}, SHA-256 {k}", "mean"))
               for k in range(30)]  # fmt: skip
    rows = short_provenance(summaries_of(several))
    assert rows[-2] == ("all 30 motions", "mean")
    assert "--json" in rows[-1][1]
    assert len(rows) == 13


def test_what_the_user_states_stands_in_the_provenance(tmp_path):
    """Unit, step and format that the user states are a step of the provenance."""
    path = tmp_path / "plain.txt"
    path.write_text("0.0\n0.5\n-0.2\n0.1\n", "utf-8")
    found = rk.read_motion(path, units="g", time_step=0.02)
    assert hashlib.sha256(path.read_bytes()).hexdigest() in found.provenance[0]
    assert found.provenance[1] == "stated by the user: unit g, time step 0.02 s"
    path = tmp_path / "own.csv"
    path.write_text("time [s],acceleration [g]\n0.0,0.0\n0.01,0.5\n0.02,-0.2\n", "utf-8")
    assert not any("stated by the user" in line for line in rk.read_motion(path).provenance)
