"""The owner's own models: a file that is edited while the server runs is asked as it is now."""

import pytest

from rocking.restitution import registry
from rocking.restitution.from_file import register_own

MODEL = """
import rocking as rk

class Mine(rk.restitution.RestitutionModel):
    name = "{name}"
    colour = "#7a5195"

    def raw_coefficient(self, body, foot):
        return {value}
"""
BODY = {"units": "m", "width": 0.5, "height": 2.0}


@pytest.fixture
def own(tmp_path, monkeypatch):
    """Write the file that the owner names, and forget its models afterwards."""
    monkeypatch.setattr(registry, "_MODELS", dict(registry._MODELS))
    path = tmp_path / "mine.py"

    def write(value, name="mine"):
        path.write_text(MODEL.format(value=value, name=name))

    write(0.5)
    monkeypatch.setenv("ROCKING_MODELS", str(path))
    return write


def test_an_edited_file_is_asked_as_it_is(client, own):
    """Twice asked the same, once with other code between: other numbers, for impacts, curves and responses."""
    document = {"body": BODY, "motion": {"pulse": "sine:amplitude=3.2,period=0.8"}, "restitution": {"models": ["mine"]}}

    def said():
        impact = client.post("/api/impact", json={"body": BODY}).json()
        (row,) = (each for each in impact["coefficients"]["right"] if each["model"] == "mine")
        (curve,) = (each for each in impact["curves"] if each["model"] == "mine")
        response = client.post("/api/response", json=document)
        assert response.status_code == 200, response.text
        (answer,) = response.json()["answers"]
        cost = answer["impacts"][0]
        kept = cost["velocity_after"] / cost["velocity_before"]
        return row["coefficient"], curve["coefficient"][0], pytest.approx(abs(kept), rel=1e-9)

    assert said() == (0.5, 0.5, 0.5)
    own(0.4)
    assert said() == (0.4, 0.4, 0.4)
    own(1.2)
    refused = client.post("/api/response", json=document)
    assert refused.status_code >= 400
    assert "r must be in [0, 1], got 1.2" in refused.json()["error"]["message"]
    info = client.get("/api/info")
    assert info.status_code == 200
    assert "mine" not in {each["name"] for each in info.json()["models"]}
    own(0.5)
    assert said() == (0.5, 0.5, 0.5)
    assert "mine" in {each["name"] for each in client.get("/api/info").json()["models"]}
    own(0.5, "other")
    assert {"mine", "other"} & {each["name"] for each in client.get("/api/info").json()["models"]} == {"other"}


def test_while_an_edited_file_is_read_its_names_are_known(client, own, tmp_path):
    """A file that looks finds its model still there, with the number that it had before."""
    assert client.post("/api/impact", json={"body": BODY}).status_code == 200
    own(0.4)
    seen = """
import rocking as rk

SEEN = rk.coefficient_of_restitution(rk.Block(width=1.0, height=2.0), "mine")
"""
    (tmp_path / "mine.py").write_text(
        seen + (tmp_path / "mine.py").read_text().replace("return 0.4", "return SEEN / 2")
    )
    (row,) = (
        each
        for each in client.post("/api/impact", json={"body": BODY}).json()["coefficients"]["right"]
        if each["model"] == "mine"
    )
    assert row["coefficient"] == 0.25


def test_the_page_lists_it(own):
    """The list of models contains the model, its colour, dash and source."""
    from rocking_workbench.api.info import _models

    own(0.5, "listed")
    assert "listed" not in {model["name"] for model in _models()}
    register_own()
    (listed,) = (model for model in _models() if model["name"] == "listed")
    assert (listed["label"], listed["colour"], listed["dash"]) == ("listed", "#7a5195", [])
    assert listed["citation"].startswith("own model, mine.py, SHA-256 ")


def test_serve_refuses_the_file(own, run, monkeypatch, tmp_path):
    """A file that is missing, or is no code, stops the server before it starts."""
    monkeypatch.setattr("rocking_workbench.command._serve", lambda *_, **__: pytest.fail("it serves"))
    own("(")
    code, _, err = run("serve", "--no-browser")
    assert (code, "rocking: " in err) == (2, True)
    (tmp_path / "mine.py").unlink()
    assert "cannot be read" in run("serve", "--no-browser")[2]
