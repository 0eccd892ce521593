"""The API under requests that nobody planned: made from its own schema, and valid ones with damage."""

import json
import os
from collections import Counter

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from web_clients import new_application, script_of

schemathesis = pytest.importorskip("schemathesis")

pytestmark = pytest.mark.verifies("damage", control="test_a_server_that_fails_is_seen", room="doors")

REQUESTS = int(os.environ.get("ROCKING_WEB_FUZZ", "200"))
"""Requests of each of the two kinds; `make fuzz-web` sends 6,500 of each."""

HEAVY = ("report.pdf", "animation", "table", "inputs.zip", "export")
INPUTS = {
    "body": {"units": "cm", "width": 50, "height": 200},
    "motion": {"pulse": "sine:amplitude=3.2,period=0.8", "scale": 1.0},
    "restitution": {"models": ["ked", "housner"]},
    "response": {"assumed_friction": 0.5},
    "settings": {"engine": "auto"},
}
ODD = [
    None,
    True,
    -1,
    0,
    1e308,
    -1e-300,
    2**70,
    "",
    "\x00",
    "=cmd|' /C calc'!A0",
    "../../etc/passwd",
    [],
    {},
    [[]],
    "\u202e",
    "nan",
]


@pytest.fixture
def script(tmp_path):
    """Return a script with the key, and an application with small limits."""
    app = new_application(tmp_path, {"histories": 2000, "studies_waiting": 2, "upload_bytes": 1 << 20})
    with script_of(app, raise_server_exceptions=False) as client:
        yield client


def damaged(draw, document):
    """Return a document with one place replaced, added or removed."""
    if isinstance(document, dict) and document and draw(st.integers(0, 4)):
        key = draw(st.sampled_from(sorted(document)))
        rest = {name: value for name, value in document.items() if name != key}
        return rest if draw(st.integers(0, 5)) == 0 else {**rest, key: damaged(draw, document[key])}
    if isinstance(document, dict):
        return {
            **document,
            draw(st.sampled_from(["file", "dxf", "name", "x", "scale", "width"])): draw(st.sampled_from(ODD)),
        }
    if isinstance(document, list) and document and draw(st.booleans()):
        return [damaged(draw, document[0]), *document[1:]]
    if isinstance(document, float | int) and not isinstance(document, bool) and draw(st.booleans()):
        return draw(st.floats(-1e6, 1e6))
    return draw(st.sampled_from(ODD))


def run(examples, test, *strategies):
    """Run a property without shrinking: what it found is in its words."""
    quiet = settings(
        max_examples=examples,
        deadline=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
        database=None,
    )
    quiet(given(*strategies)(test))()


def judged(answer, sent, seen):
    """Refuse an answer of the 500 range, a traceback, and a number that is none."""
    seen[answer.status_code] += 1
    assert answer.status_code < 500, f"{sent}: {answer.status_code} {answer.text[:300]}"
    assert "Traceback" not in answer.text[:4000]
    if answer.headers.get("content-type", "").startswith("application/json") and answer.content:
        json.loads(answer.content, parse_constant=lambda word: pytest.fail(f"{sent}: {word} in the answer"))


def sent(script, case):
    """Send what schemathesis made, past its own transport, so that the gate sees our headers."""
    body = case.body if isinstance(case.body, bytes) else b""
    if case.media_type == "application/json":
        body = json.dumps(case.body, default=str).encode("utf-8", "surrogatepass")
    head = {"Content-Type": case.media_type} if case.media_type else {}
    return script.request(case.method, case.formatted_path, params=dict(case.query or {}), content=body, headers=head)


def test_requests_from_the_schema(script):
    """Requests that schemathesis makes from the API's own schema never get a 5xx."""
    schema = schemathesis.openapi.from_dict(script.get("/api/openapi.json").json())
    found = [each.ok() for each in schema.get_all_operations()]
    assert len(found) >= 25
    seen = Counter()
    light = [each for each in found if not any(word in each.path for word in HEAVY)]
    rest = [each for each in found if each not in light]
    share = {id(each): max(8, REQUESTS // len(light)) for each in light} | {id(each): 8 for each in rest}
    for operation in found:

        def ask(case):
            judged(sent(script, case), f"{case.method} {case.formatted_path}", seen)

        run(share[id(operation)], ask, operation.as_strategy())
    print(f"{sum(seen.values())} requests from the schema: {dict(seen)}")
    assert sum(seen.values()) >= 0.7 * REQUESTS  # an operation without parameters has few different requests


def test_damaged_documents(script):
    """Valid inputs with damage are answered or refused, never with a 5xx, and both happen."""
    seen = Counter()
    light = {
        "body": ("body", "settings"), "impact": ("body", "settings"), "motion": ("motion", "settings"),
        "response": tuple(INPUTS), "inputs.toml": tuple(INPUTS),
    }  # fmt: skip

    def ask(data):
        path = data.draw(st.sampled_from(sorted(light)))
        document = {key: INPUTS[key] for key in light[path]}
        for _ in range(data.draw(st.sampled_from([0, 1, 1, 1, 2]))):
            document = damaged(data.draw, document)
        answer = script.post(f"/api/{path}", content=json.dumps(document), headers={"Content-Type": "application/json"})
        judged(answer, f"{path} {document}", seen)

    run(REQUESTS, ask, st.data())
    print(f"{sum(seen.values())} damaged documents: {dict(seen)}")
    assert seen[200] > REQUESTS // 20
    assert seen[422] > REQUESTS // 5


@pytest.mark.verifies("negative control", "an endpoint that raises")
def test_a_server_that_fails_is_seen(script, monkeypatch):
    """Negative control: an endpoint that raises is reported by the same judgement, and shows no traceback."""
    from rocking_workbench.api import response

    def broken(*_):
        raise RuntimeError("secret place")

    monkeypatch.setattr(response, "problem_from", broken)
    answer = script.post("/api/response", json=INPUTS)
    assert answer.status_code == 500
    assert "secret" not in answer.text
    with pytest.raises(AssertionError, match="500"):
        judged(answer, "response", Counter())
