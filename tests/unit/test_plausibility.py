"""What was hardly meant is doubted aloud with its likely cause, never refused; what was assumed is said as assumed."""

import json
import math
import warnings

import numpy as np
import pytest

import rocking as rk
from rocking import plausibility
from rocking.bodies.solid import Part, Solid, box
from rocking.dynamics import SpatialStart
from rocking.errors import PlausibilityWarning
from rocking.evidence import all_measurements
from rocking.restitution import model
from rocking.studies.fragility import fragility_analysis

pytestmark = pytest.mark.filterwarnings("default::rocking.errors.PlausibilityWarning")
BLOCK = rk.Block(width=0.5, height=2.0, density=500.0)
PULSE = rk.pulses.sine(amplitude=3.0, period=0.8)
TOWER = rk.Block(width=12.0, height=95.0, density=1800.0)
SLOW, BOX, HEIGHTS = PULSE.scaled(0.5), rk.dynamics.SpatialBody.box(0.5, 0.5, 2.0), ("height", [2.0, 3.0])
STATUE_2_CM = [(0.0, 0.0), (0.008, 0.0), (0.005, 0.02)]

DOUBTFUL = {
    "mm for m": (
        lambda: rk.Block(width=500.0, height=2000.0),
        "1000 m above the ground.*check that lengths are in m, not mm or cm",
    ),
    "cm for m": (
        lambda: rk.Block(width=50.0, height=200.0),
        "100 m above the ground.*check that lengths are in m, not mm or cm",
    ),
    "statue of 2 cm": (
        lambda: rk.Section.from_points(STATUE_2_CM),
        "less than the 0.025 m.*check that lengths are in m",
    ),
    "solid of 2 cm": (lambda: Solid(box(0.005, 0.006, 0.02)), "less than the 0.025 m"),
    "mass points": (lambda: rk.MassPoints([(0.1, 900.0)], [5.0], feet=(-90.0, 80.0)), "900 m above the ground"),
    "one length in mm": (lambda: rk.Block(width=500.0, height=2.0), "h/b = 0.004.*check the units"),
    "density in t/m3": (lambda: rk.Block(width=0.5, height=2.0, density=2.4), "2.4 kg/m3.*unit is kg/m3"),
    "density of a solid": (lambda: Solid(Part(box(1.0, 1.0, 2.0), 2400e3)), "osmium"),
    "amplitude in mm/s2": (lambda: rk.pulses.sine(amplitude=3000.0, period=0.8), r"3000 m/s2 \(306 g\).*unit and"),
    "record in gal": (lambda: rk.GroundMotion(np.array([0.0, 300.0, -210.0]), 0.01), "300 m/s2"),
    "scaled record": (lambda: rk.GroundMotion(np.array([0.0, 3.0]), 0.01).scaled(-9000.0), "2.7e[+]04 m/s2.*scale"),
    "period in ms": (lambda: rk.pulses.sine(amplitude=3.0, period=800.0), "period of 800 s.*in seconds"),
    "step in ms": (lambda: rk.GroundMotion(np.array([0.0, 3.0]), 5.0), "step of 5 s.*in seconds"),
    "scale": (lambda: rk.simulate(BLOCK, PULSE, scale=-9000.0), "2.7e[+]04 m/s2"),
    "scales of many": (lambda: rk.simulate_many(BLOCK, [PULSE, PULSE], scale=[1.0, -9000.0]), "2.7e[+]04 m/s2.*scale"),
    "scale with contact": (lambda: rk.simulate(BLOCK, PULSE, None, friction=0.5, scale=20.0), "60 m/s2.*scale"),
    "scale in space": (lambda: rk.simulate(BOX, {"y": PULSE}, "housner", scale=20.0), "60 m/s2.*scale"),
    "scales in space": (lambda: rk.simulate_many(BOX, {"y": PULSE}, "housner", scale=[1.0, 20.0]), "60 m/s2.*scale"),
    "scale of a spectrum": (lambda: rk.rocking_spectrum(PULSE, [0.2], [2.0], 0.9, scale=20.0), "60 m/s2.*scale"),
    "scale of a map": (lambda: rk.overturning_map(BLOCK, PULSE, ("scale", [1.0, 9000.0]), HEIGHTS), "2.7e[+]04 m/s2"),
    "pga of a map": (lambda: rk.overturning_map(BLOCK, PULSE, ("pga", [1.0, 300.0]), HEIGHTS), "300 m/s2"),
    "levels": (lambda: fragility_analysis(BLOCK, [PULSE, SLOW], [2.0, 3000.0], 0.9), "3000 m/s2.*unit"),
    "upwards": (lambda: rk.simulate_many(BLOCK, rk.GroundMotion([0, 1], 0.01, vertical=[0, 9]), scale=5.0), "45 m/s2"),
    "gravity in cm/s2": (lambda: rk.simulate(BLOCK, PULSE, gravity=981.0), "gravity of 981 m/s2.*1.6.*25.*m/s2"),
    "gravity in g": (
        lambda: rk.free_rocking(BLOCK, restitution=None, friction=0.5, gravity=1.0),
        "gravity of 1 m/s2.*unit",
    ),
    "gravity in space": (
        lambda: rk.free_rocking(BOX, restitution="housner", start=SpatialStart(0.01), gravity=981.0),
        "gravity of 981 m/s2",
    ),
    "friction in percent": (
        lambda: rk.simulate(BLOCK, PULSE, friction=40.0),
        "friction of 40 exceeds 10.*percent",
    ),
    "friction in degrees": (lambda: rk.simulate(BLOCK, PULSE, None, friction=35.0), "friction of 35.*degrees"),
    "loss for coefficient": (lambda: rk.simulate(BLOCK, PULSE, 0.07), "restitution of 0.07.*loss"),
    "loss for a model": (lambda: model("fixed", r=0.05), "restitution of 0.05"),
}


# what is scaled to 2750 g throws the block as well, and that is another warning
@pytest.mark.filterwarnings("ignore:the contact force becomes tensile")
@pytest.mark.parametrize("name", DOUBTFUL)
def test_doubts(name):
    """One warning of our class, at the user's own line, with the value, the limit and the likely cause."""
    make, words = DOUBTFUL[name]
    with pytest.warns(PlausibilityWarning, match=f"check the input: .*{words}") as caught:
        make()
    (doubt,) = (each for each in caught if issubclass(each.category, PlausibilityWarning))
    assert {each.filename for each in caught} == {__file__} == {doubt.filename}


MEANT = {
    "a specimen 6 cm high": lambda: rk.Block(width=0.02, height=0.06, density=7850.0),
    "an obelisk": lambda: rk.Block(width=2.5, height=30.0, density=2700.0),
    "a tower": lambda: rk.Block(width=12.0, height=95.0, density=1800.0),
    "a sheet of glass": lambda: rk.Block(width=0.012, height=2.0, density=2500.0),
    "foam": lambda: rk.Block(width=0.3, height=1.0, density=15.0),
    "the strongest records": lambda: rk.pulses.ricker(amplitude=35.0, period=0.3),
    "a slow pulse": lambda: rk.pulses.sine(amplitude=1.0, period=12.0),
    "a squat block": lambda: rk.coefficient_of_restitution(rk.Block(width=4.0, height=2.0, density=2400.0), "ked"),
    "stops at once": lambda: rk.simulate(BLOCK, PULSE, 0.0),
    "everyday": lambda: rk.simulate(BLOCK, PULSE, 0.9, scale=-1.5),
    "bodies that identities try": lambda: rk.restitution.identity_report(TOWER, rk.restitution.Ked()),
    "feet that never slide": lambda: rk.simulate(BLOCK, PULSE, None, friction=1e6),
    "on the Moon": lambda: rk.simulate(BLOCK, PULSE.scaled(0.1), gravity=1.62),
    "levels of a study": lambda: fragility_analysis(BLOCK, [PULSE, SLOW], [2.0, 20.0], 0.9),
    "ratios of a map": lambda: rk.overturning_map(BLOCK, PULSE, ("amplitude_ratio", [1.0, 30.0]), HEIGHTS),
    "several scales": lambda: rk.simulate_many(BLOCK, PULSE, "ked", scale=[0.5, 2.0]),
}


@pytest.mark.parametrize("name", MEANT)
def test_what_people_study_is_not_doubted(name):
    """Negative control: small specimens, towers, glass, foam and the strongest records pass without a word."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        MEANT[name]()


def test_bodies_of_the_measurements_are_not_doubted():
    """Every published specimen, at the smallest width that was measured, 2 cm, raises no doubt."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for ratio in all_measurements().slenderness.tolist():
            rk.Block(width=0.02 if ratio >= 3.0 else 0.06, height=(0.02 if ratio >= 3.0 else 0.06) * ratio)


def test_the_filter_silences():
    """A study without dimensions is silent with one line of Python's own, and computes the same."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", PlausibilityWarning)
        huge = rk.Block(width=500.0, height=2000.0)
    assert huge.slenderness_angle == pytest.approx(math.atan(0.25), rel=1e-14, abs=0.0)


def test_assumed_density_is_said(tmp_path):
    """A density that nobody gave is told apart: in Python, in facts, of parts, from files, and after scaling."""
    said = "density 2400 kg/m3 assumed"
    plain = rk.Block(width=0.8, height=1.8)
    assert plain.assumed[0].startswith(said)
    assert "not rotations" in plain.assumed[0]
    assert rk.Block(width=0.8, height=1.8, density=2400.0).assumed == ()
    assert plain.scaled(size=2.0).assumed == plain.assumed
    (heavier,) = plain.scaled(density=2.0).assumed
    assert "2400 kg/m3 assumed (plain concrete), scaled to 4800;" in heavier
    assert plain.scaled(density=2.0).to_section().assumed == (heavier,)
    assert plain.to_section().scaled(density=2.0).assumed == (heavier,)
    assert Solid(box(0.8, 0.8, 1.8)).scaled(density=2.0).assumed == (heavier,)
    assert rk.Block(width=0.8, height=1.8, density=2400.0).scaled(density=2.0).assumed == ()
    assert plain.answer()["assumed"] == plain.assumed
    mixed = rk.Section(
        [rk.Region([(0, 0), (1, 0), (1, 1), (0, 1)], 7850.0), rk.Region([(0, 1), (1, 1), (1, 2), (0, 2)])]
    )
    assert "for 1 of 2 parts" in mixed.assumed[0]
    assert "centre of mass and rotations" in mixed.assumed[0]
    file = tmp_path / "cabinet.wkt"
    file.write_text("POLYGON ((0 0, 800 0, 800 1800, 0 1800, 0 0))")
    assert rk.read_body(file, units="mm").assumed == plain.assumed
    assert rk.read_body(file, units="mm", density=300.0).assumed == ()
    assert Solid(box(0.8, 0.8, 1.8)).turned(0.3).assumed == plain.assumed
    assert Solid(Part(box(0.8, 0.8, 1.8), 300.0)).assumed == ()
    solid = tmp_path / "solid.toml"
    solid.write_text('units = "m"\n[solid]\n[[solid.part]]\nbox = { width = 0.8, depth = 0.8, height = 1.8 }\n')
    assert rk.read_body(solid).assumed == plain.assumed


def test_command_line_says_it(run):
    """`cor` and `simulate` print doubts and what was assumed; the same stands in the JSON."""
    _, out, err = run("restitution", "--width", "500", "--height", "2000")
    assert "rocking: note: check the input: the centre of mass is 1000 m" in err
    assert "density 2400 kg/m3 assumed" in out
    facts = json.loads(run("restitution", "--width", "500", "--height", "2000", "--json")[1])["body"]
    assert "1000 m" in facts["warnings"][0]
    assert "assumed" in facts["assumed"][0]
    command = ("simulate", "--width", "0.5", "--height", "2", "sine:amplitude=3000,period=0.8")
    _, out, err = run(*command)
    assert "3000 m/s2 (306 g)" in err
    assert "2400 kg/m3 assumed" in out
    facts = json.loads(run(*command, "--json")[1])
    assert facts["body"]["warnings"] == []
    assert "3000 m/s2" in facts["motion"]["warnings"][0]
    _, told, err = run("restitution", "--width", "0.5", "--height", "2", "--density", "500")
    assert err == ""
    assert "assumed" not in told


ASKED = {
    "map": ("map", "sine:amplitude=3,period=.5", "--x", "scale=1:2:2", "--y", "restitution=.8:.9:2"),
    "minimum": ("overturning-pga", "sine:amplitude=3,period=.5", "--max-pga", "6"),
    "fragility": ("fragility", "--motion", "sine:amplitude=3,period=.5", "--levels", "2:6:3"),
}


@pytest.mark.slow
@pytest.mark.parametrize("command", ASKED)
def test_studies_say_what_was_assumed(printed, answered, command):
    """Pages and JSON of studies tell an assumed density from one that was given."""
    words = (*ASKED[command], "--width", "0.5", "--height", "2")
    assert "2400 kg/m3 assumed" in printed(*words)
    assert "assumed" in answered(*words)["assumed"][0]
    assert "assumed" not in printed(*words, "--density", "2400")
    assert answered(*words, "--density", "2400")["assumed"] == []


@pytest.mark.slow
def test_assumed_friction_is_said(printed, answered, tmp_path):
    """Friction that nobody gave is assumed on page, in JSON, and in documents; what is given is given."""
    words = ("simulate", "--width", "0.5", "--height", "2", "sine:amplitude=3,period=.5")
    given = ("--set", "response.assumed_friction=0.5")
    assert "(assumed 0.5)" in printed(*words)
    assert "(given 0.5)" in printed(*words, *given)
    assert answered(*words, "--friction", "0.5")["friction_assumed"] is False
    for option in ((), given):
        answer = answered(*words, *option)
        assert (answer["friction"], answer["friction_assumed"]) == (0.5, not option)
    question = tmp_path / "question.toml"
    question.write_text(
        '[body]\nunits = "m"\nwidth = 0.5\nheight = 2\n[motion]\npulse = "sine:amplitude=3,period=.5"\n[response]\n'
    )
    assert "(assumed 0.5)" in printed("simulate", question)


def test_an_answer_has_the_warning():
    """An implausible motion has its warning in the answer."""
    from rocking.plots.labels import fine_samples
    from rocking.reports.response_facts import record_answer

    strong = rk.pulses.sine(amplitude=3000.0, period=0.8)
    assert "306 g" in record_answer(strong, fine_samples(strong), {})["warnings"][0]


def test_what_no_ground_does_is_doubted(tmp_path) -> None:
    """A velocity read as an acceleration, and one that does not come to rest, are warned of; an honest pulse is not."""
    assert plausibility.of_integrals(0.0, 1.0, 0.5) == ()
    assert "more than 5 m/s or 15 m" in plausibility.of_integrals(0.0, 1.0, 99.0)[0]
    assert "more than 5 m/s or 15 m" in plausibility.of_integrals(0.0, 6.0, 1.0)[0]
    assert "ends at 0.3 m/s" in plausibility.of_integrals(-0.3, 1.0, 0.5)[0].replace("-", "")
    time = np.arange(0.0, 20.0, 0.01)
    path = tmp_path / "record.txt"
    for values, words in (
        (np.sin(np.pi * time), None),
        (0.05 + 0.0 * time, "ends at"),
        (3.0 * np.sin(np.pi * time) ** 2, "more than"),
    ):
        path.write_text("\n".join(f"{t:.2f} {v:.6f}" for t, v in zip(time, values, strict=True)))
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            rk.read_motion(path, units="m/s2")
        assert [words in str(one.message) for one in said] == ([True] if words else [])
