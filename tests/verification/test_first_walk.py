"""From an empty folder to an overturning map with one's own restitution model, as a student walked it by the manual."""

import json
import math
import re

import pytest
import xarray
from shapely.geometry import Polygon

pytestmark = pytest.mark.slow

BODY = """
units = "cm"
name = "leaning trapezoid"

[trapezoid]
base = 80
top = 50
height = 180
lean = 12
feet = [6, 74]
depth = 50
density = 2200
"""
MODEL = '''
from dataclasses import dataclass

import rocking as rk


@dataclass(frozen=True)
class SpreadImpulse(rk.restitution.RestitutionModel):
    """A share of the energy that Housner's impact loses."""

    share: float = 0.6

    name = "spread-impulse"
    title = "a share of Housner's loss"
    reference = "a student's idea"
    assumptions = ("the loss is that of Housner, times a share",)
    domain = "plane bodies"

    def raw_coefficient(self, body, foot):
        housner = rk.coefficient_of_restitution(body, "housner", foot=foot)
        new = body.side(foot).moment_of_inertia
        old = body.side("left" if foot == "right" else "right").moment_of_inertia
        loss = 1.0 - housner**2 * new / old
        return ((1.0 - self.share * loss) * old / new) ** 0.5
'''
OUTLINE = [
    (0.0, 0.0),
    (0.8, 0.0),
    (0.77, 1.8),
    (0.27, 1.8),
]  # the body, by hand: the top's middle lies 12 cm to the right
MAP = "--motion sine:amplitude=1,period=0.8 --x frequency_ratio=0.5:8:30 --y amplitude_ratio=1:10:30"


def expected(foot, share=0.6):
    """The coefficient by Housner's equation, with moments that sums over slices of the outline give."""
    body, slices = Polygon(OUTLINE), 2000
    middles = [1.8 * (k + 0.5) / slices for k in range(slices)]
    spans = [(0.27 * y / 1.8, 0.8 - 0.03 * y / 1.8) for y in middles]
    area = sum(right - left for left, right in spans) * 1.8 / slices
    assert area == pytest.approx(body.area, rel=1e-6)
    x = body.centroid.x
    ground = sum(
        (right**3 - left**3) / 3 + (right - left) * y**2 for (left, right), y in zip(spans, middles, strict=True)
    )
    about_ground = ground * 1.8 / slices - area * x**2  # about the point of the ground below the centre
    new, old = (0.74 - x, x - 0.06) if foot == "right" else (x - 0.06, 0.74 - x)
    inertia_new, inertia_old = about_ground + area * new**2, about_ground + area * old**2
    housner = (about_ground - area * new * old) / inertia_new
    return math.sqrt((1 - share * (1 - housner**2 * inertia_new / inertia_old)) * inertia_old / inertia_new)


@pytest.mark.verifies(
    "computed anew",
    "moments of slices of the outline; two maps by themselves",
    within="2e-6 of r",
    control="within",
    room="doors",
)
def test_the_walk(tmp_path, monkeypatch, printed):
    """The own model has its coefficient, and the map counts the cells that it changes as two maps by themselves do."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lean.toml").write_text(BODY)
    (tmp_path / "mymodel.py").write_text(MODEL)
    assert "Recommended model" in printed("restitution", "lean.toml", "--recommend")
    assert "a student's idea" in printed("models", "mymodel.py:SpreadImpulse")
    own = ("--restitution", "mymodel.py:SpreadImpulse")
    text = printed("restitution", "lean.toml", *own, "--restitution", "ked", "--details")
    left, right = map(float, re.findall(r"spread-impulse\S*\s+(0\.\d+)", text))
    assert left == pytest.approx(expected("left"), abs=2e-6)  # six digits are printed
    assert right == pytest.approx(expected("right"), abs=2e-6)
    assert left != pytest.approx(expected("right"), abs=1e-3)  # the feet are not confused

    both = printed("map", "lean.toml", *MAP.split(), *own, "--restitution", "housner", "--output", "map.png")
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
    flipped, cells = map(int, re.search(r"differs in (\d+) of ([\d,]+) cells", both).groups())
    outcomes = []
    for model in (own[1], "housner"):
        printed("map", "lean.toml", *MAP.split(), "--restitution", model, "--output", "one.nc")
        with xarray.open_dataset(tmp_path / "one.nc") as table:
            outcomes.append(table["overturned"].values.copy())
    assert cells == outcomes[0].size == 900
    assert flipped == (outcomes[0] != outcomes[1]).sum() > 0
    assert json.loads(printed("simulate", "lean.toml", "sine:amplitude=3,period=0.8", *own, "--json"))
