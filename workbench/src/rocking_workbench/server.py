"""The server: data folder, address, socket, link, warm-up and clean shutdown."""

import asyncio
import contextlib
import errno
import json
import math
import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import h11
import uvicorn
from uvicorn.protocols.http.h11_impl import H11Protocol

from rocking.campaigns import CampaignBusyError
from rocking.campaigns.disk import FolderLock
from rocking.errors import InvalidValueError, RockingError
from rocking_workbench.application import create_app
from rocking_workbench.settings import DEFAULT_PORT, LOOPBACK, ServerSettings
from rocking_workbench.work import ComputationQueue

_TRIED = 50
# A restart can use the port again. On Windows, SO_REUSEADDR would also allow other programs to use the port.
_OPTION = getattr(socket, "SO_EXCLUSIVEADDRUSE", socket.SO_REUSEADDR)
_EVERYWHERE = {"0.0.0.0", "::", ""}
Step = Callable[[], Any]
_FIRST_PAGE_SECONDS = 0.5
_BREATH_SECONDS = 0.02
_BLOCK = {"units": "m", "width": 1.0, "height": 4.0}
_HEAD_SECONDS = 15.0
_CONNECTIONS = 512
_TURN = 0.0005
"""Switch interval of threads [s]: a tenth of the default of Python."""
KEY_FILE = "api-key"
_NOTE = "server.json"


def check_host(host: str, *, allow_remote: bool) -> None:
    """Refuse an address that other computers can reach, unless it is allowed."""
    if host in _EVERYWHERE:
        raise InvalidValueError(
            "{parameter} {host} means all addresses; state the address that other computers use",
            parameter="--host", host=host or repr(host),
        )  # fmt: skip
    if host not in LOOPBACK and not allow_remote:
        raise InvalidValueError(
            "{parameter} {host} is reachable from other computers without encryption; add --allow-remote to allow "
            "this", parameter="--host",
            host=host,
        )  # fmt: skip


def listen(host: str, port: int, *, search: bool) -> socket.socket:
    """Return a socket that listens."""
    if not 0 <= port <= 65535:
        raise InvalidValueError(parameter="--port", allowed="in 0 ... 65535", value=port)
    for candidate in range(port, min(port + _TRIED, 65536)) if search and port else (port,):
        try:
            return _bound(host, candidate)
        except PermissionError as error:
            raise InvalidValueError(
                "port {port} is not permitted; choose a port above 1023 with --port", port=candidate
            ) from error
        except socket.gaierror as error:
            raise InvalidValueError(
                "{parameter} {host} is not an address ({reason})", parameter="--host", host=host, reason=error.strerror
            ) from error
        except OSError as error:
            if error.errno != errno.EADDRINUSE:
                raise InvalidValueError(
                    "cannot listen on {host}: {reason}", host=host, reason=error.strerror
                ) from error
    raise InvalidValueError(
        "ports {port} to {last} are in use; choose another port with --port"
        if search and port
        else "port {port} is in use, perhaps by another rocking serve; choose another port with --port",
        port=port, last=port + _TRIED - 1,
    )  # fmt: skip


def _bound(host: str, port: int) -> socket.socket:
    family, kind, protocol, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    door = socket.socket(family, kind, protocol)
    try:
        door.setsockopt(socket.SOL_SOCKET, _OPTION, 1)
        door.bind(address)
        door.listen(256)
    except OSError:
        door.close()
        raise
    return door


def warm_up(*more: Step) -> None:
    """Fit the calibration, compute one response and draw one picture, if the extras are installed."""
    for step in (_impact, _response, _picture, *more):
        with contextlib.suppress(ImportError, RockingError):
            step()
        time.sleep(_BREATH_SECONDS)


def _impact() -> None:
    from rocking_workbench.api import impact
    from rocking_workbench.inputs import ImpactRequest

    impact.answer(ImpactRequest.model_validate({"body": _BLOCK}))


def _response() -> None:
    from rocking.motions import response_spectrum
    from rocking.motions.pulses import pulse
    from rocking.plots.labels import fine_samples
    from rocking.spec.response import problem_of
    from rocking_workbench.api.response import responses_answer
    from rocking_workbench.inputs import ResponseRequest, body_from

    option = "sine:amplitude=3,period=0.8"
    inputs = ResponseRequest.model_validate({"body": _BLOCK, "motion": {"pulse": option}})
    motion = pulse(option)
    responses_answer(problem_of(inputs, body_from(inputs.body), motion), 10)
    response_spectrum(fine_samples(motion), [1.0], 0.05)


def _picture() -> None:
    from rocking import Block
    from rocking.plots import body_picture
    from rocking_workbench.downloads.pictures import drawn

    drawn(lambda: body_picture(Block(width=1.0, height=4.0)))


class FolderInUseError(InvalidValueError):
    """Another server uses the data folder."""


class DataFolder:
    """The data folder of a server, locked while the server runs."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock = FolderLock(path)

    def __enter__(self) -> "DataFolder":
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            self.path.chmod(0o700)
        except OSError as error:
            raise InvalidValueError(
                "the data folder {folder!r} is not usable ({reason}); choose another folder with --data",
                folder=str(self.path), reason=error.strerror,
            ) from error  # fmt: skip
        try:
            self._lock.__enter__()
        except CampaignBusyError as error:
            raise FolderInUseError(
                "another rocking serve uses the data folder {folder!r}; stop that server, or choose another folder "
                "with --data", folder=str(self.path),
            ) from error  # fmt: skip
        return self

    def __exit__(self, *_: object) -> None:
        for name in (KEY_FILE, _NOTE):
            (self.path / name).unlink(missing_ok=True)
        self._lock.__exit__()

    def publish(self, url: str, key: str) -> Path:
        """Write the address for a second start and the key for scripts into private files."""
        note = {"url": url, "process": os.getpid(), "machine": socket.gethostname()}
        write_private(self.path / _NOTE, json.dumps(note))
        return write_private(self.path / KEY_FILE, key)

    def running(self) -> tuple[str, str] | None:
        """Return address and key of the server that uses the folder; None if unknown or on another machine."""
        try:
            note: dict[str, Any] = json.loads((self.path / _NOTE).read_text(encoding="utf-8"))
            key = (self.path / KEY_FILE).read_text(encoding="utf-8")
        except (OSError, ValueError):
            return None
        return (note["url"], key) if note.get("machine") == socket.gethostname() else None


def write_private(path: Path, text: str) -> Path:
    """Write a private file; an existing file is replaced."""
    path.unlink(missing_ok=True)  # do not write through a link
    handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(handle, "w", encoding="utf-8") as file:
        file.write(text)
    return path


@dataclass(frozen=True)
class Started:
    """Address and keys of a started server."""

    url: str  # address of the page
    token: str  # token for one sign-in
    port: int  # port of the server
    key_file: Path  # file with the key for scripts

    @property
    def link(self) -> str:
        """Return the link that signs a browser in."""
        return f"{self.url}/#token={self.token}"


def serve(settings: ServerSettings, started: Callable[[Started], None], *, port: int | None = None) -> None:
    """Serve until the process is stopped."""
    check_host(settings.host, allow_remote=settings.allow_remote)
    with DataFolder(settings.folder) as folder:
        wanted_port = DEFAULT_PORT if port is None else port
        with contextlib.closing(listen(settings.host, wanted_port, search=port is None)) as door:
            left = _run(replace(settings, port=door.getsockname()[1]), folder, door, started)
    if left.busy and threading.current_thread() is threading.main_thread():
        # end at once, because Python would wait for all threads that still compute
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(0)


def _run(
    settings: ServerSettings, folder: DataFolder, door: socket.socket, started: Callable[[Started], None]
) -> ComputationQueue:
    app = create_app(settings)
    sessions = app.state.rocking.sessions
    key_file = folder.publish(settings.origin, sessions.key)

    def tell() -> None:
        started(Started(settings.origin, sessions.new_link(math.inf), settings.port, key_file))
        # the schema is created after the first page is loaded, because this work delays all other requests
        timer = threading.Timer(_FIRST_PAGE_SECONDS, warm_up, (app.openapi,))
        timer.daemon = True
        timer.start()

    sys.setswitchinterval(_TURN)
    server = _Server(_config(app), tell)
    with contextlib.suppress(KeyboardInterrupt), _ended_like_ctrl_c():  # a signal ends the server
        server.run(sockets=[door])
    queue: ComputationQueue = app.state.rocking.heavy
    return queue


@contextlib.contextmanager
def _ended_like_ctrl_c() -> Iterator[None]:
    """Handle SIGTERM like Ctrl-C during the run of the server."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _config(app: Any) -> uvicorn.Config:
    return uvicorn.Config(
        app,
        http=_PatientProtocol,
        ws="websockets-sansio",
        ws_max_size=1 << 16,
        ws_per_message_deflate=False,
        proxy_headers=False,
        server_header=False,
        access_log=False,
        log_level="warning",
        limit_concurrency=_CONNECTIONS,
        timeout_keep_alive=30,
        timeout_graceful_shutdown=3,
        h11_max_incomplete_event_size=1 << 15,
    )


class _Server(uvicorn.Server):
    """A server that calls a function as soon as the first page can be opened."""

    def __init__(self, config: uvicorn.Config, tell: Callable[[], None]) -> None:
        super().__init__(config)
        self._tell = tell

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        if self.started:
            self._tell()


class _PatientProtocol(H11Protocol):
    """A protocol that closes connections whose request head arrives too late."""

    _patience: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        super().connection_made(transport)
        self._wait_for_head()

    def connection_lost(self, exc: Exception | None) -> None:
        self._have_head()
        super().connection_lost(exc)

    def handle_events(self) -> None:
        super().handle_events()
        if self.conn.their_state is not h11.IDLE:  # the head is complete, or the connection is a websocket
            self._have_head()
        elif self.conn.trailing_data[0]:
            self._wait_for_head()

    def _wait_for_head(self) -> None:
        if self._patience is None:  # further bytes of the same head do not extend the time
            self._patience = self.loop.call_later(_HEAD_SECONDS, self._lose_patience)

    def _have_head(self) -> None:
        if self._patience is not None:
            self._patience.cancel()
            self._patience = None

    def _lose_patience(self) -> None:
        if not self.transport.is_closing():
            self.transport.close()
