"""The names under which this server may be asked: a foreign name that points here is somebody's trick."""

from rocking.app.problems import NotAllowed
from rocking.app.security.asked import Asked
from rocking.app.settings import Settings

_ALWAYS = ("127.0.0.1", "localhost", "[::1]")


def own_hosts(settings: Settings) -> frozenset[str]:
    """Return every Host header that is the server's own."""
    given = f"[{settings.host}]" if ":" in settings.host else settings.host
    names = {*_ALWAYS, given.lower()}
    with_port = {f"{name}:{settings.port}" for name in names}
    return frozenset(with_port | names if settings.port == 80 else with_port)


def check_host(asked: Asked, own: frozenset[str]) -> None:
    """Refuse a request that was sent to another name."""
    if asked.headers.get("host", "").lower() not in own:
        raise NotAllowed(
            "the Host header is not this server's address: open it by the link that `rocking serve` prints"
        )
