"""Signing in: a one-time token becomes a cookie that scripts in the page cannot read."""

from fastapi import APIRouter, Request
from pydantic import BaseModel, ConfigDict, Field
from starlette.requests import HTTPConnection

from rocking.app.answers import JsonAnswer
from rocking.app.problems import NotSignedIn
from rocking.app.schemas.answers.answer import Answer
from rocking.app.security.asked import Asked
from rocking.app.state import state_of

router = APIRouter(prefix="/api/session", tags=["session"])
_PUBLIC = {("POST", "/api/session"), ("GET", "/api/session"), ("GET", "/api/openapi.json")}


class SignIn(BaseModel):
    """The token of a one-time link."""

    model_config = ConfigDict(strict=True, extra="forbid")

    token: str = Field(min_length=1, max_length=200, description="What follows #token= in the link.")


class SignedIn(Answer):
    """Whether somebody is signed in."""

    signed_in: bool


class Link(Answer):
    """A link that signs one more browser in."""

    url: str


@router.post("", summary="Exchange a one-time token for a session cookie")
def sign_in(request: Request, given: SignIn) -> SignedIn:
    """Exchange the token of a one-time link for a cookie: HttpOnly, SameSite=Strict.

    Returns True; the cookie is in the head of the answer.
    """
    state = state_of(request)
    answer = JsonAnswer({"signed_in": True})
    answer.set_cookie(
        cookie_name(state.settings.port),
        state.sessions.sign_in(given.token),
        httponly=True,
        samesite="strict",
        secure=request.url.scheme == "https",
        path="/",
    )
    return answer  # type: ignore[return-value]  # the schema documents SignedIn, the answer carries the cookie


@router.get("", summary="Whether this browser or script is signed in")
def signed_in(request: Request) -> SignedIn:
    """Return whether this browser or script is signed in."""
    return SignedIn(signed_in=is_signed_in(request))


@router.delete("", summary="Sign out")
def sign_out(request: Request) -> SignedIn:
    """Forget the session of this browser."""
    state = state_of(request)
    state.sessions.sign_out(request.cookies.get(cookie_name(state.settings.port)))
    return SignedIn(signed_in=False)


@router.post("/link", summary="Make a link that signs one more browser in")
def link(request: Request) -> Link:
    """Make a link that signs one more browser in, once, within 15 minutes."""
    state = state_of(request)
    return Link(url=f"{state.settings.origin}/#token={state.sessions.new_link()}")


def cookie_name(port: int) -> str:
    """Return the name of the session's cookie: cookies do not tell ports apart."""
    return f"rocking-{port}"


def is_signed_in(request: HTTPConnection) -> bool:
    """Return whether a request carries a live session's cookie or the key for scripts."""
    state = state_of(request)
    scheme, _, key = request.headers.get("authorization", "").partition(" ")
    if scheme.lower() == "bearer":
        return state.sessions.knows_key(key.strip())
    return state.sessions.knows(request.cookies.get(cookie_name(state.settings.port)))


def check_session(asked: Asked, request: HTTPConnection) -> None:
    """Refuse what is not public to somebody who is not signed in."""
    public = not asked.of_api or ("GET" if asked.method == "HEAD" else asked.method, asked.target) in _PUBLIC
    if not public and not is_signed_in(request):
        raise NotSignedIn(
            "nobody is signed in: open the link that `rocking serve` prints, "
            "or send Authorization: Bearer with the key in the file api-key of the data folder"
        )
