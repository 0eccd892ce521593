"""One-time links, sessions and the key for scripts: 256 bits each, kept as hashes, compared in constant time."""

import hashlib
import hmac
import secrets
import threading
import time
from collections import deque
from collections.abc import Callable

from rocking.app.problems import Busy, NotSignedIn
from rocking.app.settings import Limits

_MOST_SESSIONS = 64
_MOST_LINKS = 16
_LINK_SECONDS = 900.0
_MINUTE = 60.0
_FOREVER = float("inf")


def new_token() -> str:
    """Return 256 random bits as text."""
    return secrets.token_urlsafe(32)


class Sessions:
    """Who may ask: browsers that were signed in by a one-time link, and scripts that have the key."""

    def __init__(self, limits: Limits, clock: Callable[[], float] = time.monotonic) -> None:
        self._limits = limits
        self._clock = clock
        self._lock = threading.Lock()
        self._links: dict[bytes, float] = {}
        self._sessions: dict[bytes, float] = {}
        self._wrong: deque[float] = deque(maxlen=limits.wrong_tokens)
        self.key = new_token()

    def new_link(self, seconds: float = _LINK_SECONDS) -> str:
        """Return a token that signs one browser in, once.

        seconds: time for which it is good [s].
        """
        token = new_token()
        with self._lock:
            while len(self._links) >= _MOST_LINKS:
                self._links.pop(next(iter(self._links)))
            self._links[_digest(token)] = self._clock() + seconds
        return token

    def first_link(self) -> str:
        """Return the token of the link that is printed at the start: good once, however late."""
        return self.new_link(_FOREVER)

    def sign_in(self, token: str) -> str:
        """Use a token up, and return the value of a session's cookie.

        Returns value of the cookie: a new one every time, whatever the browser had before.
        """
        with self._lock:
            now = self._clock()
            if len(self._wrong) == self._wrong.maxlen and now - self._wrong[0] < _MINUTE:
                raise Busy("too many wrong tokens; wait a minute", seconds=_MINUTE - (now - self._wrong[0]))
            link = _found(token, self._links)
            if link is None or self._links.pop(link) < now:
                self._wrong.append(now)
                raise NotSignedIn(
                    "the link is wrong, used up or too old: take the newest one, or restart rocking serve"
                )
            while len(self._sessions) >= _MOST_SESSIONS:
                self._sessions.pop(next(iter(self._sessions)))
            value = new_token()
            self._sessions[_digest(value)] = now
        return value

    def knows(self, value: str | None) -> bool:
        """Return whether a cookie is that of a live session, which it keeps alive.

        Returns true if somebody is signed in by it.
        """
        with self._lock:
            session = _found(value, self._sessions)
            if session is None:
                return False
            now = self._clock()
            seen = self._sessions.pop(session)
            if now - seen > self._limits.session_seconds:
                return False
            self._sessions[session] = now
        return True

    def knows_key(self, key: str | None) -> bool:
        """Return whether this is the key for scripts."""
        return key is not None and hmac.compare_digest(_digest(key), _digest(self.key))

    def sign_out(self, value: str | None) -> None:
        """Forget a session."""
        with self._lock:
            session = _found(value, self._sessions)
            if session is not None:
                del self._sessions[session]


def _digest(token: str) -> bytes:
    return hashlib.sha256(token.encode("utf-8", "surrogatepass")).digest()


def _found(token: str | None, known: dict[bytes, float]) -> bytes | None:
    if token is None:
        return None
    digest = _digest(token)
    return next(iter([other for other in known if hmac.compare_digest(other, digest)]), None)
