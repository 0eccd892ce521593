"""Answers: digits, errors as the schema says them, files, long computations."""

import json
import logging
import re
import threading
from concurrent.futures import wait

import numpy as np
import pytest
from pydantic import BaseModel, ConfigDict, Field, ValidationError
from starlette.requests import Request
from web_clients import new_application, refusal, script_of

from rocking.errors import (
    BodyFileError,
    GeometryError,
    InvalidValueError,
    MissingExtraError,
    RecordError,
    UnknownModelError,
)
from rocking_workbench.answers import ErrorAnswer, JsonAnswer, attachment_headers, safe_name
from rocking_workbench.errors import Busy, NotFound, Refused, TooLarge
from rocking_workbench.work import ComputationQueue, heavy


class Asked(BaseModel):
    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)
    width: float = Field(gt=0.0)


ERRORS = {
    "invalid": (InvalidValueError("x must be > 0, got -1"), 422, "invalid-value"),
    "geometry": (GeometryError("the outline crosses itself"), 422, "geometry"),
    "body": (BodyFileError("units is missing"), 422, "body-file"),
    "record": (RecordError("no format"), 422, "record"),
    "model": (UnknownModelError("no model 'x'"), 422, "unknown-model"),
    "extra": (MissingExtraError("pip install"), 422, "missing-extra"),
    "busy": (Busy("wait", seconds=1.2), 429, "busy"),
    "large": (TooLarge("too many"), 413, "too-large"),
    "absent": (NotFound("study not found"), 404, "not-found"),
}


@pytest.fixture
def odd(app):
    """Return the application with endpoints that fail in every way."""
    pages = app.router.routes.pop()  # the pages take whatever no endpoint takes

    @app.post("/api/odd/checked")
    def checked(given: Asked) -> Asked:
        return given

    @app.get("/api/odd/nan")
    def nan() -> JsonAnswer:
        return JsonAnswer({"value": float("nan")})

    @app.get("/api/odd/implicit")
    def implicit():  # type: ignore[no-untyped-def]
        return {"value": float("inf")}

    @app.get("/api/odd/crash")
    def crash() -> None:
        raise ZeroDivisionError("a secret of the server")

    @app.get("/api/odd/needs")
    def needs() -> None:
        raise Refused("the unit is not known", needs=["units"])

    @app.get("/api/odd/heavy")
    async def slow(request: Request) -> JsonAnswer:
        return JsonAnswer(await heavy(request, sum, [1, 2]))

    @app.get("/api/odd/{name}")
    def error(name: str) -> None:
        raise ERRORS[name][0]

    app.router.routes.append(pages)
    return app


@pytest.fixture
def odd_client(odd, client):
    return client


@pytest.mark.parametrize("name", ERRORS)
def test_errors_have_one_form(odd_client, name):
    """Every error of the package becomes its status, its kind and its own sentence."""
    error, status, kind = ERRORS[name]
    answer = odd_client.get(f"/api/odd/{name}")
    assert answer.status_code == status
    told = answer.json()["error"]
    assert (told["kind"], told["message"], told["text"]) == (kind, str(error), str(error))
    assert answer.headers.get("Retry-After") == ("2" if name == "busy" else None)


def test_what_must_still_be_told_is_in_the_error(odd_client):
    """An error that asks for more says for what."""
    assert odd_client.get("/api/odd/needs").json()["error"]["needs"] == ["units"]


@pytest.mark.parametrize("name", ["crash", "nan", "implicit"])
def test_unforeseen_is_logged_and_not_told(odd_client, caplog, name):
    """A crash, a NaN or an infinity in an answer: 500, the trace in the log, no word of it to the client."""
    with caplog.at_level(logging.ERROR, "rocking_workbench"):
        answer = odd_client.get(f"/api/odd/{name}")
    assert answer.status_code == 500
    assert answer.json()["error"]["kind"] == "internal"
    assert "secret" not in answer.text
    assert "Traceback" not in answer.text
    assert "Content-Security-Policy" in answer.headers
    assert [record for record in caplog.records if record.exc_info]


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b'{"width": -1}', "width must be a number > 0, got -1"),
        (b'{"width": "1"}', "width must be a number, got '1'"),
        (b'{"width": 1, "extra": 2}', "extra"),
        (b"{}", "width is missing"),
        (b"", "the body of the request is missing"),
        (b"[]", "must be a table"),
    ],
)
def test_refused_input_is_one_sentence(odd_client, content, words):
    """What pydantic finds is told as one plain sentence."""
    head = {"Content-Type": "application/json"}
    assert words in refusal(odd_client.post("/api/odd/checked", content=content, headers=head))


def test_bytes_are_not_taken_for_json(odd_client):
    """JSON that comes as a file's bytes, past the checks of JSON, is not read as JSON."""
    head = {"Content-Type": "application/octet-stream"}
    assert odd_client.post("/api/odd/checked", content=b'{"width": 1}', headers=head).status_code == 422


def test_every_digit_arrives():
    """Any float64 comes back bit by bit, from lists and from arrays."""
    values = np.frombuffer(np.random.default_rng(1).bytes(80_000), dtype=np.float64)
    values = values[np.isfinite(values)]
    for given in (values, values.tolist(), list(values)):
        back = np.array(json.loads(JsonAnswer({"values": given}).body)["values"])
        assert (back.view(np.int64) == values.view(np.int64)).all()


def test_word_nan_is_not_the_number():
    """A text "NaN" is a text; only the number is refused."""
    assert json.loads(JsonAnswer({"name": "NaN Infinity"}).body) == {"name": "NaN Infinity"}
    for bad in (float("nan"), np.float64("inf"), np.array([1.0, -np.inf])):
        with pytest.raises(ValueError, match="not JSON compliant"):
            JsonAnswer({"name": "NaN", "value": bad})


@pytest.mark.parametrize(
    ("given", "kept"),
    [
        ("El Centro 1940.AT2", "El-Centro-1940.AT2"),
        ("../../etc/passwd", "etc-passwd"),
        ("=cmd|' /C calc'!A0.csv", "cmd-C-calc-A0.csv"),
        ('a"; filename="evil.exe', "a-filename-evil.exe"),
        ("a\r\nSet-Cookie: x=1", "a-Set-Cookie-x-1"),
        ("CON", "rocking-CON"),
        ("com1.csv", "rocking-com1.csv"),
        (".htaccess", "rocking.htaccess"),
        ("photo\u202egpj.exe", "photogpj.exe"),
        ("<svg onload=alert(1)>.svg", "svg-onload-alert-1.svg"),
        ("\x00", "rocking"),
        ("Σίσυφος", "rocking"),
        ("statue v1.2 report.pdf", "statue-v1.2-report.pdf"),
        ("statue v1.2", "statue-v1.2"),
        ("..\\..\\v1.2\\a.csv", "v1.2-a.csv"),
        ("a/./b/../.ssh/c.csv", "a-b-ssh-c.csv"),
        ("v1...2..csv", "v1-2.csv"),
        ("trailing. . .", "trailing"),
        ("name .csv", "name.csv"),
        ("nul.v1.2.csv", "rocking-nul.v1.2.csv"),
        ("COM\u00b9.csv", "rocking-COM1.csv"),
        ("a\x00.\x1fb\x7f.csv", "a-b.csv"),
        ("1\uff0e2\u2024\u2024/\uff0ecsv", "1.2.csv"),
        ("x" * 73 + ".y.z" * 9 + ".csv", "x" * 73 + ".y.csv"),
        ("con" + "." * 300 + ".csv", "rocking-con.csv"),
    ],
)
def test_file_names_are_harmless(given, kept):
    """Whatever a file is called, its name on the way out is plain."""
    assert safe_name(given) == kept
    assert attachment_headers(given)["Content-Disposition"] == f'attachment; filename="{kept}"'
    for name in (kept, safe_name(given * 1000), safe_name(given, "study")):
        assert re.fullmatch(r"[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+)*", name)
        assert len(name) <= 80


def test_line_of_computations_is_bounded():
    """One at work and one waiting is all there is room for; the next is told to come again, until one is done."""
    line, go = ComputationQueue(1, 1), threading.Event()
    futures = [line.submit(go.wait, 10), line.submit(int, "7")]
    with pytest.raises(Busy, match="2 computations"):
        line.submit(int, "8")
    go.set()
    wait(futures)
    assert line.submit(int, "9").result(10) == 9
    line.close()


def test_failed_computation_leaves_the_line():
    """A computation that raises leaves its place to the next."""
    line = ComputationQueue(1, 0)
    for _ in range(3):
        future = line.submit(int, "no number")
        assert isinstance(future.exception(10), ValueError)
        wait([future])
    line.close()


def test_heavy_work_comes_back(odd_client):
    """An endpoint gets the result of a computation in a thread."""
    assert odd_client.get("/api/odd/heavy").json() == 3


BLOCK = {"units": "cm", "width": 50, "height": 200}
REQUESTS = {
    401: ("GET", "/api/info", None),
    403: ("POST", "/api/body", {"body": BLOCK}),
    404: ("GET", f"/api/records/{'0' * 64}", None),
    405: ("DELETE", "/api/body", None),
    413: ("POST", "/api/body", {"body": {"units": "m", "regular_polygon": {"sides": 10_001, "radius": 1.0}}}),
    415: ("POST", "/api/body", "text"),
    422: ("POST", "/api/body", {"body": {**BLOCK, "width": -1}}),
}


@pytest.fixture(scope="module")
def schema(tmp_path_factory):
    with script_of(new_application(tmp_path_factory.mktemp("schema"))) as script:
        return script.get("/api/openapi.json").json()


@pytest.mark.parametrize("status", REQUESTS)
def test_errors_are_what_the_schema_says(client, schema, status):
    """A real answer of each status has the declared form, and the operation declares that status with that form."""
    method, path, content = REQUESTS[status]
    head = {401: {"Authorization": "Bearer x"}, 403: {"Origin": "http://evil.example"}}.get(status, {})
    if isinstance(content, str):
        answer = client.request(method, path, content=content, headers={"Content-Type": "text/plain"})
    else:
        answer = client.request(method, path, json=content, headers=head)
    assert answer.status_code == status
    told = ErrorAnswer.model_validate(answer.json())
    assert told.error.message
    place = next(each for each in schema["paths"] if path.startswith(each.partition("{")[0]) and each.count("/") >= 2)
    for operation in schema["paths"][place].values():
        assert operation["responses"][str(status)] == {"$ref": f"#/components/responses/Error{status}"}
    declared = schema["components"]["responses"][f"Error{status}"]
    assert declared["content"]["application/json"]["schema"] == {"$ref": "#/components/schemas/ErrorAnswer"}
    assert declared["description"]


def test_another_form_is_noticed():
    """The control: the form of the framework, and a kind that nobody knows, are not the declared form."""
    for other in ({"detail": "no"}, {"error": {"kind": "odd", "message": "no"}}, {"error": {"kind": "busy"}}):
        with pytest.raises(ValidationError):
            ErrorAnswer.model_validate(other)


def test_every_call_declares_its_errors_and_its_key(app):
    """No operation declares the form of the framework; all but those of the session ask for the key."""
    schema = app.openapi()
    assert "HTTPValidationError" not in str(schema)
    assert schema["components"]["securitySchemes"]["key"]["scheme"] == "bearer"
    assert "Retry-After" in schema["components"]["responses"]["Error429"]["headers"]
    for path, item in schema["paths"].items():
        for operation in item.values():
            assert {"400", "401", "403", "404", "413", "422", "429"} <= set(operation["responses"])
            assert bool(operation["security"]) == (path != "/api/session")
