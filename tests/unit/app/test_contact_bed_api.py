"""POST /api/contact-bed: the laboratory of the contact bed."""

import math
from typing import get_args

import numpy as np
import pytest
from web_clients import refusal

from rocking.app.api.contact_bed import MOST_POINTS, Varied
from rocking.studies.impact_laboratory import STUDIES, Laboratory, study


def asked(client, **table):
    """Answer of a study."""
    answer = client.post("/api/contact-bed", json=table)
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_what_python_finds_and_the_closed_form_beside_it(client):
    """Numbers are those of `study`; Housner is its closed form, and slender blocks lose less."""
    found = asked(client, **{"from": 2, "to": 6}, count=4, damping=0.3)
    same = study("slenderness", np.linspace(2.0, 6.0, 4), Laboratory(damping=0.3))
    for name, each in found["results"].items():
        assert each["values"] == same[name].values.tolist()
    expected = [1.0 - 1.5 * math.sin(math.atan(1.0 / x)) ** 2 for x in found["values"]]
    assert found["rigid"]["housner"] == pytest.approx(expected, rel=1e-12)
    assert all(np.diff(found["results"]["coefficient"]["values"]) > 0.0)
    assert found["results"]["peak_force"]["unit"] == "N"


@pytest.mark.parametrize("varied", STUDIES)
def test_everything_that_can_change_has_a_usual_range(client, varied):
    """Each study of Python is offered, and answers where nothing but its name is said."""
    assert set(get_args(Varied)) == set(STUDIES)
    found = asked(client, varied=varied, count=5, points=21)
    assert len(found["values"]) == len(found["results"]["coefficient"]["values"]) == 5
    assert all(abs(each) < 1e-6 for each in found["results"]["audit"]["values"])


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"varied": "damping", "from": 0}, "must be > 0"),
        ({"varied": "damping", "shape": "convex"}, "has no options, got shape"),
        ({"varied": "points", "to": MOST_POINTS + 1}, f"at most {MOST_POINTS}"),
        ({"count": 201}, "count"),
        ({"from": -1, "to": 2}, "slenderness must be > 0, got -1"),
        ({"width": 0}, "width"),
        ({"wdith": 1}, "unknown key"),
        ({"varied": "release", "to": 1}, "release"),
        ({"varied": "width", "to": 1e308}, "must be"),
    ],
)
def test_what_cannot_be_is_refused_in_words(client, table, words):
    """Ranges and keys that cannot be are told, and give no number."""
    assert words in refusal(client.post("/api/contact-bed", json=table))
