"""The schema of the API says of errors what the server really answers."""

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from pydantic import ValidationError

from rocking.app.schemas.answers import ErrorAnswer

BLOCK = {"units": "cm", "width": 50, "height": 200}
ASKED = {
    401: ("GET", "/api/info", None),
    403: ("POST", "/api/body", {"body": BLOCK}),
    404: ("GET", f"/api/records/{'0' * 64}", None),
    405: ("DELETE", "/api/body", None),
    413: ("POST", "/api/body", {"body": {"units": "m", "regular_polygon": {"sides": 10_001, "radius": 1.0}}}),
    415: ("POST", "/api/body", "text"),
    422: ("POST", "/api/body", {"body": {**BLOCK, "width": -1}}),
}


@pytest.mark.parametrize("status", ASKED)
def test_errors_are_what_the_schema_says(client: TestClient, status: int) -> None:
    """A real answer of each status has the declared form, and the operation declares that status with that form."""
    method, path, content = ASKED[status]
    head = {401: {"Authorization": "Bearer x"}, 403: {"Origin": "http://evil.example"}}.get(status, {})
    if isinstance(content, str):
        answer = client.request(method, path, content=content, headers={"Content-Type": "text/plain"})
    else:
        answer = client.request(method, path, json=content, headers=head)
    assert answer.status_code == status
    told = ErrorAnswer.model_validate(answer.json())
    assert told.error.message
    schema = client.get("/api/openapi.json").json()
    place = next(each for each in schema["paths"] if path.startswith(each.partition("{")[0]) and each.count("/") >= 2)
    for operation in schema["paths"][place].values():
        assert operation["responses"][str(status)] == {"$ref": f"#/components/responses/Error{status}"}
    declared = schema["components"]["responses"][f"Error{status}"]
    assert declared["content"]["application/json"]["schema"] == {"$ref": "#/components/schemas/ErrorAnswer"}
    assert declared["description"]


def test_another_form_is_noticed() -> None:
    """The control: the form of the framework, and a kind that nobody knows, are not the declared form."""
    for other in ({"detail": "no"}, {"error": {"kind": "odd", "message": "no"}}, {"error": {"kind": "busy"}}):
        with pytest.raises(ValidationError):
            ErrorAnswer.model_validate(other)


def test_every_call_declares_its_errors_and_its_key(app: FastAPI) -> None:
    """No operation declares the form of the framework; all but those of the session ask for the key."""
    schema = app.openapi()
    assert "HTTPValidationError" not in str(schema)
    assert schema["components"]["securitySchemes"]["key"]["scheme"] == "bearer"
    assert "Retry-After" in schema["components"]["responses"]["Error429"]["headers"]
    for path, item in schema["paths"].items():
        for operation in item.values():
            assert {"400", "401", "403", "404", "413", "422", "429"} <= set(operation["responses"])
            assert bool(operation["security"]) == (path != "/api/session")
