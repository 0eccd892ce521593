"""Which page sends a request: only our own may change anything, and no other may read."""

from rocking.app.problems import NotAllowed
from rocking.app.security.asked import Asked

_OWN_SITES = {"same-origin", "none"}


def check_origin(asked: Asked, own: frozenset[str]) -> None:
    """Refuse a request of another page; one that may change something must say where it comes from."""
    origin = asked.headers.get("origin")
    if origin is None:
        if asked.unsafe:
            name = asked.headers.get("host", "127.0.0.1")
            raise NotAllowed(f"the Origin header is missing: a script sends Origin: {asked.scheme}://{name}")
    elif origin.lower() not in {f"{asked.scheme}://{name}" for name in own}:
        raise NotAllowed("the Origin header names another page than this server's own")


def check_site(asked: Asked) -> None:
    """Refuse what a browser sends on behalf of another site, but for somebody following a link to a page."""
    site = asked.headers.get("sec-fetch-site")
    if site is None or site in _OWN_SITES:
        return
    follows_link = (
        asked.headers.get("sec-fetch-mode") == "navigate" and asked.headers.get("sec-fetch-dest") == "document"
    )
    if asked.unsafe or asked.of_api or not follows_link:
        raise NotAllowed("another site asks for this")
