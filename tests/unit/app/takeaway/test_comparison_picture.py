"""The picture of several responses: names as people know them, and no two curves alike."""

import xml.etree.ElementTree as ET

import rocking as rk
from rocking.app.takeaway.comparison_picture import _looks, comparison_picture
from rocking.evidence._coefficient_table import default_models

BODY = rk.Block(width=0.5, height=2.0).with_feet(0.05, 0.5)
PULSE = rk.pulses.sine(3.0, 0.8)
LABELS = [each.label for each in default_models()] + [
    "0.98*ked", "shifted-impulse:k=0.5", "shifted-impulse:k=0.6", "0.8", "0.9", "left 0.9, right 0.8",
]  # fmt: skip


def test_models_are_named(client) -> None:
    """Legend, verdict and rows name models by words; no label of the command line is left in the pictures."""
    labels = {"models": ["ked", "housner", "horizontal-momentum"], "values": [0.8]}
    inputs = {
        "body": {"units": "m", "width": 0.5, "height": 2.0},
        "motion": {"pulse": "sine:amplitude=3,period=0.8"},
        "restitution": labels,
    }
    for what in ("response", "coefficients"):
        picture = client.post(f"/api/picture/{what}.svg", json=inputs).content
        told = [text.strip().replace("\u00a0", " ") for text in ET.fromstring(picture).itertext() if text.strip()]
        assert not any(word in text for text in told for word in ("housner", "ked", "horizontal-momentum"))
        assert any("horizontal momentum (cos\u00b2\u03b1)" in text for text in told)
    page = client.post("/api/animation.html", json=inputs).text
    assert "restitution KED;" in page


def test_no_two_curves_look_alike() -> None:
    """Colour and dash together are different for every restitution, also for two of one family."""
    looks = _looks(LABELS)
    assert len({str(look) for look in looks.values()}) == len(LABELS)
    ked, other = looks["ked"], looks["0.98*ked"]
    assert ked["color"] != other["color"]


def test_every_response_has_its_curve() -> None:
    """Each of three responses is in each of three panels."""
    found = {label: rk.simulate(BODY, PULSE, label) for label in ("ked", "housner")} | {
        "0.8": rk.simulate(BODY, PULSE, 0.8)
    }
    figure = comparison_picture(found)
    colors = [look["color"] for look in _looks(list(found)).values()]
    for panel in figure.axes[1:4]:
        assert {line.get_color() for line in panel.get_lines()} >= set(colors)
