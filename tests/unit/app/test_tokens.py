"""One-time links, sessions, the key."""

import re

import pytest
from fastapi.testclient import TestClient

from rocking.app.errors import Busy, NotSignedIn
from rocking.app.security.sessions import Sessions, new_token
from rocking.app.settings import Limits

ORIGIN = {"Origin": "http://127.0.0.1:8765"}


class Clock:
    def __init__(self) -> None:
        self.now = 1000.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def sessions(clock: Clock) -> Sessions:
    return Sessions(Limits(), clock)


def test_tokens_have_256_bits_and_differ() -> None:
    """A token is 43 letters of the URL alphabet (32 bytes), and none comes twice."""
    tokens = {new_token() for _ in range(1000)}
    assert len(tokens) == 1000
    assert all(re.fullmatch(r"[A-Za-z0-9_-]{43}", token) for token in tokens)


def test_link_works_once(sessions: Sessions) -> None:
    """The token of a link signs one browser in and is used up."""
    token = sessions.first_link()
    assert sessions.knows(sessions.sign_in(token))
    with pytest.raises(NotSignedIn):
        sessions.sign_in(token)


def test_later_link_gets_too_old(sessions: Sessions, clock: Clock) -> None:
    """A link for another browser is good for 15 minutes, the first one for ever."""
    first, early, late = sessions.first_link(), sessions.new_link(), sessions.new_link()
    clock.now += 899.0
    assert sessions.knows(sessions.sign_in(early))
    clock.now += 2.0
    with pytest.raises(NotSignedIn):
        sessions.sign_in(late)
    clock.now += 1e6
    assert sessions.knows(sessions.sign_in(first))


def test_session_ends_after_idle_hours(sessions: Sessions, clock: Clock) -> None:
    """A session that is used stays; one that is idle for more than 12 h ends."""
    value = sessions.sign_in(sessions.first_link())
    for _ in range(3):
        clock.now += 12 * 3600.0
        assert sessions.knows(value)
    clock.now += 12 * 3600.0 + 1.0
    assert not sessions.knows(value)


def test_eleventh_wrong_token_within_a_minute_is_not_looked_at(sessions: Sessions, clock: Clock) -> None:
    """After ten wrong tokens the door is shut for the rest of the minute, for the right one too."""
    token = sessions.first_link()
    for _ in range(10):
        with pytest.raises(NotSignedIn):
            sessions.sign_in("wrong")
    with pytest.raises(Busy) as caught:
        sessions.sign_in(token)
    assert caught.value.seconds == pytest.approx(60.0)
    clock.now += 60.0
    assert sessions.knows(sessions.sign_in(token))


def test_nothing_secret_is_kept_but_the_key(sessions: Sessions) -> None:
    """Links and sessions are kept as hashes: what they are cannot be read from memory."""
    token = sessions.first_link()
    kept = repr({name: value for name, value in vars(sessions).items() if name != "key"})
    value = sessions.sign_in(token)
    kept += repr({name: value for name, value in vars(sessions).items() if name != "key"})
    assert token not in kept
    assert value not in kept


def test_number_of_sessions_and_links_is_bounded(sessions: Sessions) -> None:
    """The 65th browser takes the place of the one that was idle longest; the 17th link that of the oldest."""
    values = [sessions.sign_in(sessions.new_link()) for _ in range(64)]
    assert sessions.knows(values[0])
    newest = sessions.sign_in(sessions.new_link())
    assert sessions.knows(newest)
    assert sessions.knows(values[0])
    assert not sessions.knows(values[1])
    links = [sessions.new_link() for _ in range(17)]
    with pytest.raises(NotSignedIn):
        sessions.sign_in(links[0])
    assert sessions.sign_in(links[1])


def test_browser_signs_in_and_out(stranger: TestClient) -> None:
    """A link becomes a cookie that scripts cannot read and other sites cannot send, until somebody signs out."""
    token = stranger.app.state.rocking.sessions.first_link()
    assert stranger.get("/api/session").json() == {"signed_in": False}
    answer = stranger.post("/api/session", json={"token": token}, headers=ORIGIN)
    assert answer.json() == {"signed_in": True}
    words = answer.headers["Set-Cookie"].lower().split("; ")
    assert words[0].startswith("rocking-8765=")
    assert {"httponly", "samesite=strict", "path=/"} <= set(words)
    assert "secure" not in words  # the connection is not encrypted: with it the browser would drop the cookie
    assert not [word for word in words if word.startswith("domain")]
    assert stranger.get("/api/session").json() == {"signed_in": True}
    assert stranger.delete("/api/session", headers=ORIGIN).json() == {"signed_in": False}
    assert stranger.get("/api/session").json() == {"signed_in": False}


def test_cookie_is_secure_where_the_connection_is(app: object) -> None:
    """Behind an encrypted connection the cookie is marked Secure."""
    with TestClient(app, base_url="https://127.0.0.1:8765") as browser:  # type: ignore[arg-type]
        token = browser.app.state.rocking.sessions.first_link()  # type: ignore[attr-defined]
        head = {"Origin": "https://127.0.0.1:8765"}
        answer = browser.post("/api/session", json={"token": token}, headers=head)
    assert "; secure" in answer.headers["Set-Cookie"].lower()


def test_signed_in_browser_makes_a_link_for_another(client: TestClient, stranger: TestClient) -> None:
    """A link made by somebody signed in signs a stranger in."""
    url = client.post("/api/session/link").json()["url"]
    assert url.startswith("http://127.0.0.1:8765/#token=")
    token = url.partition("#token=")[2]
    assert stranger.post("/api/session", json={"token": token}, headers=ORIGIN).status_code == 200
    assert stranger.get("/api/session").json() == {"signed_in": True}
