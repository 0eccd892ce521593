"""Colours of models and series: told apart by eyes of every kind, and strong enough on light and dark ground."""

import itertools
import re
from pathlib import Path

import numpy as np
import pytest

import rocking
from rocking.plots.style import COLORS, LINES
from rocking.restitution import models

STATIC = Path(rocking.__file__).parent / "app" / "static"
# Machado, Oliveira and Fernandes (2009), DOI 10.1109/TVCG.2009.113, Table 1, severity 1.0: on linear red, green, blue
SIGHTS = {
    "every cone": np.eye(3),
    "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "tritanopia": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
}
TO_XYZ = np.array(  # IEC 61966-2-1
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
LEAST = 10.0  # CIEDE2000
GROUNDS = ("#ffffff", "#1d2125")  # on which pictures stand: `--surface`, light and dark


def linear(colour):
    c = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def contrast(one, other):
    """WCAG 2.2: relative luminances."""
    low, high = sorted(float(TO_XYZ[1] @ linear(each)) for each in (one, other))
    return (high + 0.05) / (low + 0.05)


def lab(rgb):
    t = TO_XYZ @ np.clip(rgb, 0.0, 1.0) / [0.95047, 1.0, 1.08883]
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def ciede2000(one, other):
    """Sharma, Wu and Dalal (2005), DOI 10.1002/col.20070."""
    (l1, a1, b1), (l2, a2, b2) = one, other
    mean = (np.hypot(a1, b1) + np.hypot(a2, b2)) / 2
    more = 1.5 - 0.5 * np.sqrt(mean**7 / (mean**7 + 25**7))
    c1, c2 = np.hypot(more * a1, b1), np.hypot(more * a2, b2)
    h1, h2 = (np.degrees(np.arctan2(b, more * a)) % 360 for a, b in ((a1, b1), (a2, b2)))
    turn = (h2 - h1 + 180) % 360 - 180 if c1 * c2 else 0.0
    dh, light, c = 2 * np.sqrt(c1 * c2) * np.sin(np.radians(turn / 2)), (l1 + l2) / 2, (c1 + c2) / 2
    h = h1 + turn / 2 if c1 * c2 else h1 + h2
    t = 1 - 0.17 * np.cos(np.radians(h - 30)) + 0.24 * np.cos(np.radians(2 * h))
    t += 0.32 * np.cos(np.radians(3 * h + 6)) - 0.20 * np.cos(np.radians(4 * h - 63))
    around = 60 * np.exp(-((((h % 360) - 275) / 25) ** 2))
    rotation = -np.sin(np.radians(around)) * 2 * np.sqrt(c**7 / (c**7 + 25**7))
    dl = (l2 - l1) / (1 + 0.015 * (light - 50) ** 2 / np.sqrt(20 + (light - 50) ** 2))
    dc, dh = (c2 - c1) / (1 + 0.045 * c), dh / (1 + 0.015 * c * t)
    return float(np.sqrt(dl**2 + dc**2 + dh**2 + rotation * dc * dh))


@pytest.mark.parametrize(
    ("one", "other", "apart"),
    [  # Sharma, Wu and Dalal (2005), Table 1: pairs 1, 7, 13, 16, 24, 25, 34
        ((50.0, 2.6772, -79.7751), (50.0, 0.0, -82.7485), 2.0425),
        ((50.0, 0.0, 0.0), (50.0, -1.0, 2.0), 2.3669),
        ((50.0, -0.0010, 2.4900), (50.0, 0.0011, -2.4900), 4.7461),
        ((50.0, 2.5, 0.0), (50.0, 0.0, -2.5), 4.3065),
        ((50.0, 2.5, 0.0), (50.0, 3.2592, 0.3350), 1.0000),
        ((60.2574, -34.0099, 36.2677), (60.4626, -34.1751, 39.4387), 1.2644),
        ((2.0776, 0.0795, -1.1350), (0.9033, -0.0636, -0.5514), 0.9082),
    ],
)
def test_the_distance_is_the_published_one(one, other, apart):
    """CIEDE2000 of published pairs, to their last digit."""
    assert ciede2000(one, other) == pytest.approx(apart, abs=6e-5)


def in_page(name):
    """Colours of a list in the page's palette."""
    text = (STATIC / "app" / "palette.js").read_text("utf-8")
    return re.findall(r"#[0-9A-F]{6}", re.search(rf"const {name} = \[(.*?)\];", text, re.DOTALL)[1])


def families():
    """Colours that stand beside each other in one picture."""
    kinds = [kind for kind in models().values() if kind.colour]
    return {"models": [kind.colour for kind in kinds], "series": list(COLORS), "angles": in_page("ANGLES")}


@pytest.mark.parametrize("family", ["models", "series", "angles"])
def test_no_two_look_alike(family):
    """Any two of a picture are CIEDE2000 10 apart for normal sight and each of three deficiencies."""
    for sight, matrix in SIGHTS.items():
        seen = {colour: lab(np.asarray(matrix) @ linear(colour)) for colour in families()[family]}
        near = {(a, b): ciede2000(seen[a], seen[b]) for a, b in itertools.combinations(seen, 2)}
        assert min(near.values()) >= LEAST, (sight, min(near, key=near.get))


@pytest.mark.parametrize("family", ["models", "series", "angles"])
def test_strong_on_both_grounds(family):
    """A line stands out from its ground as WCAG 2.2, 1.4.11 asks of graphics: 3 to 1, by day and by night."""
    for colour, ground in itertools.product([*families()[family], *in_page("SPARE")], GROUNDS):
        assert contrast(colour, ground) >= 3.0, (colour, ground)


def test_dashes_differ_too():
    """In grey print: no two models, and no two series, have one line."""
    dashes = [kind.linestyle for kind in models().values() if kind.colour]
    assert len(set(map(str, dashes))) == len(dashes)
    assert len(set(map(str, LINES))) == len(LINES)


def test_the_old_colours_are_noticed():
    """Negative control: Okabe and Ito's seven with two purples look alike to some, and two are too pale for paper."""
    old = ["#D55E00", "#0072B2", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#8C6BB1", "#332288"]
    seen = [lab(np.asarray(SIGHTS["protanopia"]) @ linear(colour)) for colour in old]
    assert min(ciede2000(a, b) for a, b in itertools.combinations(seen, 2)) < 3.0
    assert sum(contrast(colour, "#ffffff") < 3.0 for colour in old) == 2
