"""Where the server listens: loopback unless more is asked for in so many words, and a port that is free."""

import errno
import socket

from rocking.app.settings import LOOPBACK
from rocking.errors import InvalidValueError

_TRIED = 50
# so that a restart finds its port free; on Windows the same option would let a stranger take it
_OPTION = getattr(socket, "SO_EXCLUSIVEADDRUSE", socket.SO_REUSEADDR)
_EVERYWHERE = {"0.0.0.0", "::", ""}


def check_host(host: str, *, allow_remote: bool) -> None:
    """Refuse an address that others reach, unless that is wanted."""
    if host in _EVERYWHERE:
        raise InvalidValueError(
            f"--host {host or repr(host)} is every address at once: name the one under which others open the page"
        )
    if host not in LOOPBACK and not allow_remote:
        raise InvalidValueError(
            f"--host {host} can be reached from other machines, over a connection that is not encrypted: "
            "add --allow-remote if that is meant; without it the server listens on 127.0.0.1 only"
        )


def listen(host: str, port: int, *, search: bool) -> socket.socket:
    """Return a socket that listens."""
    if not 0 <= port <= 65535:
        raise InvalidValueError(f"--port must be in 0 ... 65535, got {port}")
    for candidate in range(port, min(port + _TRIED, 65536)) if search and port else (port,):
        try:
            return _bound(host, candidate)
        except PermissionError as error:
            raise InvalidValueError(
                f"port {candidate} is not free to use: choose one above 1023 with --port"
            ) from error
        except socket.gaierror as error:
            raise InvalidValueError(f"--host {host} is not an address ({error.strerror})") from error
        except OSError as error:
            if not _taken(error):
                raise InvalidValueError(f"cannot listen on {host}: {error.strerror}") from error
    raise InvalidValueError(
        f"ports {port} to {port + _TRIED - 1} are taken: choose another with --port"
        if search and port
        else f"port {port} is taken, perhaps by another rocking serve: choose another with --port"
    )


def _taken(error: OSError) -> bool:
    return error.errno == errno.EADDRINUSE


def _bound(host: str, port: int) -> socket.socket:
    family, kind, protocol, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    door = socket.socket(family, kind, protocol)
    try:
        door.setsockopt(socket.SOL_SOCKET, _OPTION, 1)
        door.bind(place)
        door.listen(256)
    except OSError:
        door.close()
        raise
    return door
