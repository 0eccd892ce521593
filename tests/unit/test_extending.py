"""What docs/extending.md says of a model, a pulse and a law of one's own is so."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics import ImpactLaw
from rocking.errors import InvalidValueError
from rocking.motions import Measure, Pulse, intensity, intensity_measures, measure, measures, pulses, scaled_to
from rocking.plots.labels import axis_label, short_name
from rocking.studies import SyntheticSet
from rocking.studies.fragility import compare_measures, fragility_analysis

PAGE = (Path(__file__).parents[2] / "docs" / "extending.md").read_text(encoding="utf-8")
BODY = rk.Block(width=0.5, height=2.0).with_feet(0.05, 0.5)


def section(title):
    """Text of a section, and the names that its code defines."""
    text = re.split(r"^## ", PAGE.partition(f"## {title}\n")[2], flags=re.M)[0]
    names = {"__name__": "written_in_the_page"}
    for code in re.findall(r"```python\n(.*?)```", text, flags=re.S):
        exec(code, names)
    return text, names


def test_the_model_of_the_page():
    """The page's model, 1 - (b/h)^2, is 15/16 for a block of h/b = 4."""
    _, names = section("A restitution model in your own file")
    assert rk.coefficient_of_restitution(BODY, names["Mine"]()) == pytest.approx(15.0 / 16.0, rel=1e-14, abs=0.0)


def test_the_pulse_of_the_page():
    """The page's pulse is (1 - cos w t) a / 2: it ends with a T / 2 and a T^2 / 4, scales, and rocks a block."""
    text, names = section("A pulse")
    pulse = names["Versine"](3.0, 0.8)
    time = np.linspace(0.0, 0.8, 9)
    np.testing.assert_allclose(pulse.acceleration(time), 1.5 * (1.0 - np.cos(2.5 * np.pi * time)), rtol=0.0, atol=1e-14)
    assert pulse.velocity(0.8).item() == pytest.approx(1.2, rel=1e-14, abs=0.0)
    assert pulse.displacement(0.8).item() == pytest.approx(0.48, rel=1e-14, abs=0.0)
    assert pulse.scaled(-2.0).peak == 6.0
    with pytest.raises(InvalidValueError, match="peak of a pulse"):
        pulse.scaled(1e9)
    # 3 m/s2 is more than g b/h = 2.45 m/s2, half of it is not
    assert rk.simulate(BODY, pulse, 0.9).peak_rotation > 0.0
    assert rk.simulate(BODY, pulse, 0.9, scale=0.5).peak_rotation == 0.0
    # every method that must be answered is named in the text, and without one there is no pulse
    for missing in Pulse.__abstractmethods__:
        assert missing in text
        answers = {name: getattr(names["Versine"], name) for name in Pulse.__abstractmethods__ - {missing}}
        with pytest.raises(TypeError, match=missing):
            type("Incomplete", (Pulse,), answers)()


def test_the_measure_of_the_page_is_at_every_door(monkeypatch, printed, tmp_path):
    """One entry, and commands, studies, scaling, sets of records, pictures, the page and NRML know the measure."""
    _, names = section("An intensity measure")
    rms = replace(names["rms"], openquake=("RMS", "2 m/s2", 0.5))
    assert "rms" not in measures()
    monkeypatch.setitem(intensity.MEASURES, "rms", rms)
    record = rk.GroundMotion([0.0, 3.0, -4.0, 0.0], 0.1)
    assert intensity_measures(record)["rms"] == Measure("root mean square of the acceleration", 2.5, "m/s2")
    assert measure("RMS") is rms
    assert scaled_to(record, "rms", 5.0).peak == 8.0
    assert "so that RMS is 5 m/s2" in scaled_to(record, rms, 5.0).provenance[-1]
    made = SyntheticSet("point-source", 2, 1, rms=1.0)
    assert [rms.of(motion) for motion in (made[0], made[1])] == pytest.approx([1.0, 1.0], rel=1e-14, abs=0.0)
    assert made.description()["rms_m_s2"] == 1.0
    pulse = ("record", "show", "sine:amplitude=3,period=0.8")
    assert "Root mean square of the acceleration" in printed(*pulse)
    assert json.loads(printed(*pulse, "--json"))["intensity"]["rms"] == pytest.approx(4.5**0.5, rel=1e-3)
    file = tmp_path / "curves.xml"
    words = ("fragility", "--width", "0.4", "--height", "1.6", "--synthetic", "point-source", "--count", "30")
    more = ("--im", "rms", "--levels", "0.2:1.4:25", "--output", str(file), "--crossing-curves", "common-dispersion")
    assert "rms" in printed(*words, *more)
    assert 'imt="RMS"' in file.read_text("utf-8")
    assert axis_label("rms") == "root mean square of the acceleration [m/s$^2$]"
    assert short_name("rms") == "RMS"
    shaken = [pulses.half_sine(a, t) for a in (3.0, 3.5, 4.0) for t in (0.2, 0.3, 0.4)]
    found = fragility_analysis(rk.Block(width=0.4, height=1.6), shaken, restitution=0.9, im="rms", analysis="cloud")
    assert {score.im for score in compare_measures(found, ["rms", "pga"]).scores} == {"rms", "pga"}


def test_a_pulse_is_known_by_name_once_it_is_listed(monkeypatch):
    """A function in `_ALL` is in the catalogue and understood as one word; one that is not listed is not."""
    _, names = section("A pulse")

    def versine(amplitude, period):
        return names["Versine"](amplitude, period)

    monkeypatch.setattr(pulses, "versine", versine, raising=False)
    with pytest.raises(LookupError, match="unknown pulse 'versine'"):
        pulses.pulse("versine:amplitude=3,period=0.8")
    monkeypatch.setattr(pulses, "_ALL", (*pulses._ALL, versine))
    assert pulses.catalogue()["versine"] is versine
    assert pulses.pulse("versine:amplitude=3,period=0.8") == names["Versine"](3.0, 0.8)


def test_a_law_of_ones_own():
    """A law that only `factor` knows runs with the reference engine by itself, times `times`; the fast one refuses."""

    class Wearing(ImpactLaw):
        times = 0.9

        def factor(self, speed, key, impact):
            return 0.9**impact

    with pytest.raises(InvalidValueError, match="engine must be reference"):
        rk.free_rocking(BODY, 0.1, Wearing(), engine="fast")
    response = rk.free_rocking(BODY, 0.1, Wearing(), most_events=3)
    assert response.engine.startswith("reference")
    ratios = response.impacts["velocity_after"] / response.impacts["velocity_before"]
    np.testing.assert_allclose(np.abs(ratios), [0.9, 0.81, 0.729], rtol=1e-12)
