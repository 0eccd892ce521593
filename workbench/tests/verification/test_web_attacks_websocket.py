"""Attacks on the websocket by its handshake: a foreign page, name or person hears nothing."""

import pytest
from starlette.websockets import WebSocketDisconnect
from web_clients import Page

from rocking_workbench.security import gate

pytestmark = pytest.mark.verifies(room="doors")


@pytest.fixture
def page(tmp_path):
    return Page(tmp_path)


SOCKETS = {
    "foreign origin": {"origin": "http://evil.example"},
    "no origin": {"origin": None},
    "null origin": {"origin": "null"},
    "another port of this machine": {"origin": "http://localhost:3000"},
    "rebinding": {"host": "evil.example:8765", "origin": "http://evil.example:8765"},
    "no session": {"cookie": None},
    "wrong session": {"cookie": "rocking-8765=" + "A" * 43},
    "token in the query": {"cookie": None, "query": "token={token}&key={key}"},
    "cross-site": {"sec-fetch-site": "cross-site"},
    "key as a protocol": {"cookie": None, "sec-websocket-protocol": "bearer, {key}"},
}


def shakes_hands(page, changed):
    head = {**page.head, **changed}
    query = (head.pop("query", None) or "").format(**page.known)
    told = {name: value.format(**page.known) for name, value in head.items() if value is not None}
    try:
        with page.client.websocket_connect(f"/api/studies/live?{query}", headers=told):
            return True
    except WebSocketDisconnect:
        return False


@pytest.mark.verifies("damage", control="test_without_the_checks_the_websocket_is_hijacked")
@pytest.mark.parametrize("name", SOCKETS)
def test_websocket_is_not_hijacked(page, name):
    """A handshake from another page, name or person is refused before anything is said."""
    assert not shakes_hands(page, SOCKETS[name])


@pytest.mark.verifies("negative control", "the check of Origin switched off")
def test_without_the_checks_the_websocket_is_hijacked(page, monkeypatch):
    """Negative control: our own page shakes hands, and without the check of Origin a foreign one does."""
    assert shakes_hands(page, {})
    monkeypatch.delitem(gate.CHECKS, "origin")
    assert shakes_hands(page, SOCKETS["foreign origin"])
