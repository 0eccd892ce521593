"""What the server is told when it starts."""

import os
import sys
from dataclasses import dataclass, field
from pathlib import Path

MEBIBYTE = 1 << 20
LOOPBACK = ("127.0.0.1", "localhost", "::1")
DEFAULT_PORT = 8765


@dataclass(frozen=True)
class Limits:
    """How much one server takes on, and how much it accepts at once.

    Parameters
    ----------
    upload_bytes : int
        Largest file that is taken [bytes].
    json_bytes : int
        Largest JSON document [bytes].
    json_depth : int
        Deepest nesting of a JSON document.
    bytes_in_flight : int
        All request bodies that are held at once [bytes].
    body_seconds : float
        Longest time in which a request body may arrive [s].
    target_bytes : int
        Longest path and query of a request [bytes].
    records_bytes : int
        Disk for uploaded records [bytes].
    studies_bytes : int
        Disk for studies [bytes].
    histories : int
        Largest study [histories].
    studies_waiting : int
        Studies that may wait in line.
    heavy_at_once : int
        Threads for long computations.
    heavy_waiting : int
        Long computations that may wait in line.
    wrong_tokens : int
        Wrong tokens a minute before the door stays shut for a while.
    session_seconds : float
        Idle time after which a browser must sign in again [s].
    """

    upload_bytes: int = 32 * MEBIBYTE
    json_bytes: int = 2 * MEBIBYTE
    json_depth: int = 32
    bytes_in_flight: int = 256 * MEBIBYTE
    body_seconds: float = 30.0
    target_bytes: int = 4096
    records_bytes: int = 1024 * MEBIBYTE
    studies_bytes: int = 8192 * MEBIBYTE
    histories: int = 2_000_000
    studies_waiting: int = 8
    heavy_at_once: int = 2
    heavy_waiting: int = 32
    wrong_tokens: int = 10
    session_seconds: float = 12 * 3600.0


def default_folder() -> Path:
    """Return the folder in which this user's records and studies are kept.

    Returns
    -------
    Path
        Under the system's folder for the data of programs; not created here.
    """
    if sys.platform == "win32":
        root = os.environ.get("LOCALAPPDATA") or str(Path.home() / "AppData" / "Local")
    else:
        root = os.environ.get("XDG_DATA_HOME") or str(Path.home() / ".local" / "share")
    return Path(root) / "rocking"


@dataclass(frozen=True)
class Settings:
    """What the server is told when it starts.

    Parameters
    ----------
    host : str
        Address to listen on.
    port : int
        Port to listen on.
    folder : Path
        Data folder: records, studies, the key for scripts.
    allow_remote : bool
        Whether an address that other machines reach is allowed.
    workers : int, optional
        Processes for a study; by default what the campaign chooses.
    limits : Limits
        How much it accepts.
    """

    host: str = "127.0.0.1"
    port: int = DEFAULT_PORT
    folder: Path = field(default_factory=default_folder)
    allow_remote: bool = False
    workers: int | None = None
    limits: Limits = Limits()

    @property
    def origin(self) -> str:
        """Return the address of the page, without a path.

        Returns
        -------
        str
            Scheme, host and port.
        """
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"http://{host}:{self.port}"
