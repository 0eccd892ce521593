"""What there is to choose from: every registered model, in JSON that any reader takes, and each of them answers."""

import json
import math
from dataclasses import MISSING, fields

import pytest

import rocking as rk
from rocking.app.schemas.answers import Info
from rocking.restitution import models

BODY = {"units": "m", "width": 0.6, "height": 1.8}


def refuse_constant(word):
    """Stand for a reader of JSON that knows no NaN and no Infinity."""
    raise ValueError(f"{word} is no JSON")


@pytest.fixture
def told(client):
    """Return the answer, read by a strict reader."""
    answer = client.get("/api/info")
    assert answer.status_code == 200
    return json.loads(answer.text, parse_constant=refuse_constant)


def test_the_strict_reader_has_teeth():
    """An infinite number, as Python writes it, is refused by the reader of these tests."""
    with pytest.raises(ValueError, match="Infinity is no JSON"):
        json.loads(json.dumps({"friction": math.inf}), parse_constant=refuse_constant)


def test_every_registered_model_is_listed(told):
    """Names and order are those of the registry, and the answer has the form that the schema states."""
    assert [one["name"] for one in told["models"]] == list(models())
    Info.model_validate(told)


def test_a_default_is_a_number_unlimited_or_missing(told):
    """The defaults are those of the classes: a number, the word for an infinite one, null where one must be given."""
    for one in told["models"]:
        for field in fields(models()[one["name"]]):
            if not field.init:
                continue
            said = one["parameters"][field.name]["default"]
            if field.default is MISSING:
                assert said is None
            elif field.default == math.inf:
                assert said == "unlimited"
            else:
                assert said == field.default
    (bed,) = (one for one in told["models"] if one["name"] == "contact-bed")
    assert bed["parameters"]["friction"]["default"] == "unlimited"


def complete(model):
    """Say what the page says of a model that needs no number: it is offered."""
    return all(one["default"] is not None for one in model["parameters"].values())


def test_the_page_offers_every_model_that_needs_no_number(told):
    """By the rule of the page, a model is offered if and only if it can be made without arguments."""
    for one in told["models"]:
        try:
            models()[one["name"]]()
        except TypeError:
            assert not complete(one), one["name"]
        else:
            assert complete(one), one["name"]


def test_the_contact_bed_answers_at_impact(client):
    """The coefficient of the contact bed is that of the library to the last digit."""
    answer = client.post("/api/impact", json={"body": BODY, "onto": "right"})
    assert answer.status_code == 200
    rows = json.loads(answer.text, parse_constant=refuse_constant)["coefficients"]["right"]
    (bed,) = (row for row in rows if row["model"] == "contact-bed")
    block = rk.Block(width=0.6, height=1.8)
    assert bed["coefficient_of_restitution"] == rk.coefficient_of_restitution(block, "contact-bed")


def test_the_contact_bed_answers_in_a_response(client):
    """Its response is that of the library to the last digit, alone and with parameters that are told."""
    names = ["contact-bed", "contact-bed:points=5,friction=2"]
    asked = {"body": BODY, "motion": {"pulse": "sine:amplitude=6,period=0.8"}, "restitution": {"models": names}}
    answer = client.post("/api/response", json=asked)
    assert answer.status_code == 200, answer.text
    motion = rk.pulses.sine(6.0, 0.8)
    for name, one in zip(names, json.loads(answer.text, parse_constant=refuse_constant)["answers"], strict=True):
        response = rk.simulate(rk.Block(width=0.6, height=1.8), motion, restitution=name)
        assert one["peak_rotation_rad"] == response.peak_rotation > 0.0
