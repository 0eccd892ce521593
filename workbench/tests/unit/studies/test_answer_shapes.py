"""Every answer of every operation has the shape that the schema of the API declares."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient
from waiting import wait_for
from web_clients import new_application, script_of

jsonschema = pytest.importorskip("jsonschema_rs")

Tables = dict[str, Any]
OCTETS = {"Content-Type": "application/octet-stream"}
RECORD = "\n".join(f"{value:.6f}" for value in 0.3 * np.sin(0.06 * np.arange(800))).encode()
BLOCK = {"units": "cm", "width": 50, "height": 200, "name": "vase"}
HOLLOW = {
    "units": "m",
    "section": {
        "region": [
            {"outline": [[0, 0], [1, 0], [0.8, 3], [0, 3]], "density": 2000, "holes": [[[0.2, 1], [0.6, 1], [0.4, 2]]]}
        ]
    },
}
POINTS = {"units": "m", "mass_points": {"points": [[0, 1], [1, 1], [0.5, 4]], "masses": [1, 2, 3], "feet": [0, 1]}}
PULSE = {"pulse": "sine:amplitude=3,period=0.8", "scale": 2.0}
MODELS = {"models": ["ked", "housner"], "values": [0.8]}
MOVED = {"body": BLOCK, "motion": PULSE, "restitution": MODELS}
SHORT = {"body": BLOCK, "motion": {"pulse": "sine:amplitude=12,period=0.4"}, "restitution": {"value": 0.5}}
FREE = {"body": HOLLOW, "restitution": {"value": 0.9}, "response": {"initial_rotation": 0.4}}
SYNTHETIC = {"synthetic": "pulse-like", "seed": 3, "scale": 3.0}
STUDIES = {
    "overturning-map": {},
    "rocking-spectrum": {"spectrum": {"slenderness_angles": [0.2, 0.3], "periods": [2.0, 4.0]}, "body": None},
    "stripes": {
        "fragility": {"levels": [2.0, 4.0, 6.0, 8.0, 10.0], "limit_states": []},
        "motions": {"synthetic": "pulse-like", "count": 12, "seed": 7},
    },
    "cloud": {"fragility": {"im": "pgv"}, "motions": {"synthetic": "pulse-like", "count": 12, "seed": 7}},
    "incremental": {
        "fragility": {"levels": [2.0, 4.0, 8.0, 12.0]},
        "motions": {"pulse": [f"sine:amplitude={a},period={p}" for a in (2.0, 4.0) for p in (0.4, 0.7)]},
    },
    "histories": {"histories": {"scales": [1.0, 9.0]}},
    "minimum-acceleration": {"minimum": {"samples": 20}},
}
ENDINGS = {
    "/api/table/{what}.{kind}": [("body", "csv"), ("body", "xlsx"), ("body", "mat"), ("body", "nc")],
    "/api/animation.{kind}": [("", "html"), ("", "gif")],
    "/api/report.pdf": [("", "")],
    "/api/inputs.toml": [("", "")],
    "/api/inputs.zip": [("", "")],
    "/api/studies/{study}/export.{kind}": [
        ("", kind) for kind in ("nc", "csv", "mat", "xlsx", "parquet", "toml", "svg", "xml")
    ],
}


@dataclass
class Asker:
    """A script that checks whatever it is told against the schema, and counts what it has asked."""

    client: TestClient
    schema: dict[str, Any]
    validators: dict[tuple[str, str], Any] = field(default_factory=dict)
    seen: set[tuple[str, str]] = field(default_factory=set)
    answers: list[tuple[tuple[str, str], Any]] = field(default_factory=list)

    def declared(self, place):
        """Return what an operation declares of its good answer."""
        method, path = place
        responses = self.schema["paths"][path][method]["responses"]
        (found,) = [told for status, told in responses.items() if status.startswith("2")]
        return found

    def faults(self, place, value):
        """Return where a value does not have the declared shape, by a validator that is not ours."""
        if place not in self.validators:
            shape = self.declared(place)["content"]["application/json"]["schema"]
            document = {**shape, "components": self.schema["components"]}
            self.validators[place] = jsonschema.Draft202012Validator(document)
        return [str(fault) for fault in self.validators[place].iter_errors(value)]

    def ask(self, method, path, *, fill=None, **how):
        """Return a good answer in JSON, which has the declared shape."""
        answer = self.client.request(method, path.format(**(fill or {})), **how)
        assert answer.status_code < 300, f"{path}: {answer.text[:500]}"
        place, value = (method.lower(), path), answer.json()
        assert self.faults(place, value) == []
        self.seen.add(place)
        self.answers.append((place, value))
        return value

    def take(self, method, path, *, fill=None, **how):
        """Return a file, whose type is a declared one."""
        answer = self.client.request(method, path.format(**(fill or {})), **how)
        assert answer.status_code == 200, f"{path}: {answer.text[:500]}"
        place = (method.lower(), path)
        assert answer.headers["Content-Type"].partition(";")[0] in self.declared(place)["content"]
        self.seen.add(place)
        return answer.content


@pytest.fixture
def asker(folder, computed, map_job):
    """Return a script, and the names of finished studies by kind."""
    made = {}
    for kind, tables in STUDIES.items():
        own = {"map": None} if kind != "overturning-map" else {}
        made[kind] = computed(map_job(4, **{"campaign": {"name": kind, "kind": kind}, **own, **tables})).id
    job = map_job(4, restitution={"model": "ked"})
    job["map"]["refine"] = 1
    made["refined"] = computed(job).id
    app = new_application(folder, workers=1)
    with script_of(app) as client:
        yield Asker(client, app.openapi()), made


def _ask_projects(script):
    made = script.ask("POST", "/api/projects", json={"name": "hall", "document": {"inputs": {}}})
    one, version = {"project": made["id"]}, made["version"]
    saved = script.ask(
        "POST", "/api/projects/{project}", fill=one, json={"version": version, "document": {"n": 1}, "description": "n"}
    )
    undone = script.ask("POST", "/api/projects/{project}/undo", fill=one, json={"version": saved["version"]})
    done = script.ask("POST", "/api/projects/{project}/redo", fill=one, json={"version": undone["version"]})
    past = {"version": done["version"], "state": 1}
    back = script.ask("POST", "/api/projects/{project}/restore", fill=one, json=past)
    script.ask("POST", "/api/projects/{project}/name", fill=one, json={"version": back["version"], "name": "depot"})
    script.ask("GET", "/api/projects/{project}/history", fill=one)
    script.ask("GET", "/api/projects/{project}", fill=one)
    file = script.take("GET", "/api/projects/{project}/file", fill=one)
    script.ask("POST", "/api/projects/import", content=file, headers={"Content-Type": "application/octet-stream"})
    script.ask("DELETE", "/api/projects/{project}", fill=one)
    script.ask("GET", "/api/projects")
    script.ask("POST", "/api/projects/{project}/back", fill=one)


def _ask_questions(script):
    octets = {"Content-Type": "application/octet-stream"}
    content = b"name,width_cm,depth_cm,height_cm\nvase,20,20,100\n"
    sent = script.ask("POST", "/api/files", params={"name": "list.csv"}, content=content, headers=octets)
    tables = {
        "campaign": {"name": "hall", "kind": "inventory"},
        "inventory": {"objects": "list.csv", "pga": "0.3g"},
        "motions": [{"synthetic": "point-source", "count": 4, "seed": 1}],
    }
    asked = {"command": "inventory", "tables": tables, "files": {"list.csv": sent["record"]}}
    one = {"question": script.ask("POST", "/api/questions", json=asked)["id"]}
    shown = ("GET", "/api/questions/{question}")
    found = wait_for(lambda: (said := script.ask(*shown, fill=one))["state"] not in {"waiting", "running"} and said)
    assert found["state"] == "done", found["message"]
    script.take("GET", "/api/questions/{question}/{file}", fill={**one, "file": "inventory.csv"})
    script.ask("POST", "/api/questions/{question}/stop", fill=one)
    script.ask("GET", "/api/questions")
    script.ask("DELETE", "/api/questions/{question}", fill=one)


def test_every_answer_has_the_declared_shape(asker, map_job):
    """All operations are asked, with every kind of body, motion and study; damaged answers do not have the shape."""
    script, studies = asker
    _ask_session_and_records(script)
    _ask_bodies(script)
    _ask_studies(script, studies, map_job(3))
    _take_files(script, studies["stripes"])
    _ask_projects(script)
    _ask_questions(script)
    operations = {(method, path) for path, item in script.schema["paths"].items() for method in item}
    assert script.seen == operations, operations - script.seen
    assert len(operations) >= 29
    kinds = {(place, tuple(value)): value for place, value in script.answers if isinstance(value, dict)}
    refused = sum(_refused_when_damaged(script, place, value) for (place, _), value in kinds.items())
    assert refused > 200


def _ask_session_and_records(script):
    link = script.ask("POST", "/api/session/link")["url"]
    script.ask("POST", "/api/session", json={"token": link.partition("#token=")[2]})
    script.ask("GET", "/api/session")
    script.ask("DELETE", "/api/session")
    script.ask("GET", "/api/info")
    kept = script.ask("POST", "/api/records", params={"name": "a.txt"}, content=RECORD, headers=OCTETS)["record"]
    told = {"units": "g", "time_step": 0.01}
    script.ask("GET", "/api/records")
    script.ask("GET", "/api/records/{record}", fill={"record": kept}, params=told)
    script.ask("POST", "/api/motion", json={"motion": {"record": kept, **told}, "points": 20})
    script.ask("DELETE", "/api/records/{record}", fill={"record": kept})


def _ask_bodies(script):
    for body in (BLOCK, HOLLOW, POINTS, {"units": "m", "ellipse": {"width": 1, "height": 4, "feet": [-0.02, 0.02]}}):
        script.ask("POST", "/api/body", json={"body": body})
        script.ask("POST", "/api/impact", json={"body": body})
    script.ask("POST", "/api/contact-bed", json={"varied": "damping", "count": 3, "points": 11})
    words = {"name": "a.wkt", "units": "m"}
    outline = b"POLYGON ((0 0, 1 0, 1 3, 0 3, 0 0))"
    script.ask("POST", "/api/body/file", params=words, content=outline, headers=OCTETS)
    for motion in (PULSE, SYNTHETIC):
        script.ask("POST", "/api/motion", json={"motion": motion, "points": 20})
    script.ask("POST", "/api/motion", json={"motion": PULSE, "spectrum": False, "points": 20})
    for inputs in (MOVED, FREE, {**MOVED, "motion": SYNTHETIC}):
        script.ask("POST", "/api/response", json={**inputs, "points": 20})
    text = script.take("POST", "/api/inputs.toml", json=MOVED)
    script.ask("POST", "/api/inputs/read", content=text, headers=OCTETS)


def _ask_studies(script, studies, job):
    for study in studies.values():
        script.ask("GET", "/api/studies/{study}/result", fill={"study": study})
        script.ask("GET", "/api/studies/{study}/cell", fill={"study": study}, params={"x": 1, "points": 20})
    made = script.ask("POST", "/api/studies", json={"job": job})["id"]
    script.ask("GET", "/api/studies")
    script.ask("GET", "/api/studies/{study}", fill={"study": made})
    script.ask("POST", "/api/studies/{study}/cancel", fill={"study": made})
    script.ask("POST", "/api/studies/{study}/resume", fill={"study": made})
    script.ask("DELETE", "/api/studies/{study}", fill={"study": made})


def _take_files(script, study):
    for path, endings in ENDINGS.items():
        for what, kind in endings:
            fill = {"what": what, "kind": kind, "study": study}
            if "{study}" in path:
                script.take("GET", path, fill=fill)
            else:
                script.take("POST", path, fill=fill, json=SHORT)


def _refused_when_damaged(script, place, value):
    """Return how many damages of an answer were noticed: a key that is not declared, a number that is a text."""
    for key in value.keys() - {"document", "answer"}:  # whatever a user or a command puts there
        text_or_none = value[key] is None or isinstance(value[key], str)
        for other in ({"odd": {"odd": [{}]}}, [0.5] if text_or_none else "odd text"):
            assert script.faults(place, {**value, key: other}), f"{place}: {key} may be {other}"
    assert script.faults(place, {**value, "odd": 1}), place
    return len(value) + 1


def test_every_number_has_its_unit(client):
    """Each number that is declared says in words what it is measured in."""
    script = Asker(client, client.get("/api/openapi.json").json())
    shapes = script.schema["components"]["schemas"]
    told = set()
    for path, item in script.schema["paths"].items():
        for method in item:
            content = script.declared((method, path)).get("content", {}).get("application/json", {})
            told |= _named(content.get("schema", {}), shapes, set())
    bare = [
        f"{name}.{key}"
        for name in told - set(_named(_asked(script.schema), shapes, set()))
        for key, one in shapes[name].get("properties", {}).items()
        if _holds_numbers(one) and not any(word in one.get("description", "") for word in ("[", "unit"))
    ]
    assert len(told) > 60
    assert bare == [], " ".join(bare)


def _named(shape, shapes, known):
    """Return the names of all shapes that a shape is made of."""
    if isinstance(shape, list):
        shape = dict(enumerate(shape))
    if isinstance(shape, dict):
        name = str(shape.get("$ref", "")).rpartition("/")[2]
        if name and name not in known:
            known.add(name)
            _named(shapes[name], shapes, known)
        for key, one in shape.items():
            if key != "$ref":
                _named(one, shapes, known)
    return known


def _asked(schema):
    """Return what is sent, whose units depend on what the user says."""
    return [each.get("requestBody") for item in schema["paths"].values() for each in item.values()]


def _holds_numbers(shape):
    if isinstance(shape, list):
        return any(_holds_numbers(one) for one in shape)
    if not isinstance(shape, dict):
        return False
    inner = (shape.get(key) for key in ("anyOf", "items", "prefixItems", "additionalProperties"))
    return shape.get("type") == "number" or any(_holds_numbers(one) for one in inner)
