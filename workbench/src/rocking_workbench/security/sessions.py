"""Sign-in: one-time links, session cookies that scripts of a page cannot read, and the key for scripts."""

import hashlib
import hmac
import json
import secrets
import threading
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any

from fastapi import APIRouter, Request
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, TypeAdapter
from starlette.requests import HTTPConnection

from rocking.campaigns.disk import write_new
from rocking_workbench.answers import JsonAnswer, shape
from rocking_workbench.errors import Busy, Refused
from rocking_workbench.settings import Limits, state_of

router = APIRouter(prefix="/api/session", tags=["session"])
_MOST_SESSIONS = 64
_MOST_LINKS = 16
_LINK_SECONDS = 900.0
_MINUTE = 60.0
_KEPT_EVERY = 600.0  # interval at which the last use of sessions is stored on disk [s]
_KEPT = TypeAdapter(dict[Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")], FiniteFloat])


class SignIn(BaseModel):
    """The token of a one-time link."""

    model_config = ConfigDict(strict=True, extra="forbid")

    token: str = Field(min_length=1, max_length=200, description="Token after #token= in the link.")


SignedIn: Any = shape("SignedIn", "State of the session.", signed_in=bool)
Link: Any = shape("Link", "A sign-in link for another browser.", url=str)


@router.post("", summary="Exchange a one-time token for a session cookie")
def sign_in(request: Request, token: SignIn) -> SignedIn:
    """Exchange the token of a one-time link for a cookie: HttpOnly, SameSite=Strict.

    The answer is True, and its head contains the cookie.
    """
    state = state_of(request)
    answer = JsonAnswer({"signed_in": True})
    answer.set_cookie(
        cookie_name(state.settings.port),
        state.sessions.sign_in(token.token),
        httponly=True,
        samesite="strict",
        secure=request.url.scheme == "https",
        path="/",
    )
    return answer  # the response has the cookie; SignedIn is only for the schema


@router.get("", summary="Check the session")
def signed_in(request: Request) -> SignedIn:
    """Return True if the request has a valid session or key."""
    return SignedIn(signed_in=is_signed_in(request))


@router.delete("", summary="Sign out")
def sign_out(request: Request) -> SignedIn:
    """Delete the session of this browser."""
    state = state_of(request)
    state.sessions.sign_out(request.cookies.get(cookie_name(state.settings.port)))
    return SignedIn(signed_in=False)


@router.post("/link", summary="Create a sign-in link for another browser")
def link(request: Request) -> Link:
    """Create a one-time sign-in link for another browser, valid for 15 minutes."""
    state = state_of(request)
    return Link(url=f"{state.settings.origin}/#token={state.sessions.new_link()}")


def cookie_name(port: int) -> str:
    """Return the name of the session cookie, different for each port."""
    return f"rocking-{port}"


def is_signed_in(request: HTTPConnection) -> bool:
    """Return True if a request has the cookie of a valid session, or the key for scripts."""
    state = state_of(request)
    scheme, _, key = request.headers.get("authorization", "").partition(" ")
    if scheme.lower() == "bearer":
        return state.sessions.knows_key(key.strip())
    return state.sessions.knows(request.cookies.get(cookie_name(state.settings.port)))


def new_token() -> str:
    """Return 256 random bits as text."""
    return secrets.token_urlsafe(32)


class Sessions:
    """Access rights: of browsers after sign-in with a one-time link, and of scripts with the key.

    A file stores the sessions for a restart. The file contains digests, from which no cookie can be computed.
    """

    def __init__(self, limits: Limits, clock: Callable[[], float] = time.time, kept: Path | None = None) -> None:
        self._limits = limits
        self._clock = clock
        self._kept = kept
        self._lock = threading.Lock()
        self._links: dict[bytes, float] = {}
        self._sessions: dict[bytes, float] = self._read()
        self._written = clock()
        self._wrong: deque[float] = deque(maxlen=limits.wrong_tokens)
        self.key = new_token()

    def new_link(self, seconds: float = _LINK_SECONDS) -> str:
        """Return a token for one sign-in; `seconds` is its time of validity, which may be infinite [s]."""
        token = new_token()
        with self._lock:
            while len(self._links) >= _MOST_LINKS:
                self._links.pop(next(iter(self._links)))
            self._links[_digest(token)] = self._clock() + seconds
        return token

    def sign_in(self, token: str) -> str:
        """Invalidate a token, and return the value of a new cookie."""
        with self._lock:
            now = self._clock()
            if len(self._wrong) == self._wrong.maxlen and now - self._wrong[0] < _MINUTE:
                raise Busy("too many wrong tokens; wait a minute", seconds=_MINUTE - (now - self._wrong[0]))
            link = _known(token, self._links)
            if link is None or self._links.pop(link) < now:
                self._wrong.append(now)
                raise Refused(
                    "the link is wrong, used up or too old: take the newest one, or restart rocking serve", status=401
                )
            while len(self._sessions) >= _MOST_SESSIONS:
                self._sessions.pop(next(iter(self._sessions)))
            value = new_token()
            self._sessions[_digest(value)] = now
            self._write()
        return value

    def knows(self, value: str | None) -> bool:
        """Return True if the value is the cookie of a valid session, and extend this session."""
        with self._lock:
            session = _known(value, self._sessions)
            if session is None:
                return False
            now = self._clock()
            seen = self._sessions.pop(session)
            if now - seen > self._limits.session_seconds:
                return False
            self._sessions[session] = now
            if now - self._written > _KEPT_EVERY:
                self._write()
        return True

    def knows_key(self, key: str) -> bool:
        """Return True for the key for scripts."""
        return hmac.compare_digest(_digest(key), _digest(self.key))

    def sign_out(self, value: str | None) -> None:
        with self._lock:
            self._sessions.pop(_known(value, self._sessions) or b"", None)
            self._write()

    def _read(self) -> dict[bytes, float]:
        """Return the valid sessions of an earlier server; a session with a time in the future is not valid."""
        try:
            kept = _KEPT.validate_json(self._kept.read_bytes()) if self._kept else {}
        except (OSError, ValueError):
            return {}
        now = self._clock()
        live = sorted((seen, key) for key, seen in kept.items() if 0.0 <= now - seen <= self._limits.session_seconds)
        return {bytes.fromhex(key): seen for seen, key in live[-_MOST_SESSIONS:]}

    def _write(self) -> None:
        """Store the sessions in a private file. If the disk is full, a restart requires a new sign-in."""
        self._written = self._clock()
        if self._kept is not None:
            with suppress(OSError):
                content = json.dumps({key.hex(): seen for key, seen in self._sessions.items()})
                write_new(self._kept, content.encode())
                self._kept.chmod(0o600)


def _digest(token: str) -> bytes:
    return hashlib.sha256(token.encode("utf-8", "surrogatepass")).digest()


def _known(token: str | None, digests: dict[bytes, float]) -> bytes | None:
    digest = _digest(token or "")
    return next(iter([other for other in digests if hmac.compare_digest(other, digest)]), None)
