"""A command that a server runs: `python -m rocking.app.questions.child FOLDER COMMAND WORDS ...`.

It runs `rocking COMMAND WORDS ...` in a folder, with limits, and opens nothing that was not sent there. It ends when
the server does: its standard input is a pipe.
"""

import os
import sys
import threading
from pathlib import Path
from runpy import run_module
from typing import Any

_MEMORY, _SECONDS, _FILE = 8 << 30, 1800, 512 << 20  # limits: memory [bytes], time of processors [s], a file [bytes]
_SYSTEM = ("/usr", "/lib", "/lib64", "/opt", "/proc", "/sys", "/dev", "/etc/fonts", "/etc/localtime", "/etc/mime.types")


def main(arguments: list[str]) -> None:
    """Run a command."""
    from rocking.app.studies.child import end_with_the_server

    folder = Path(arguments[0]).resolve()
    threading.Thread(target=end_with_the_server, daemon=True).start()
    _limit()
    from rocking.errors import RockingError
    from rocking.evidence.store import store
    from rocking.restitution.from_file import register_own

    try:
        register_own()  # the owner's own models, which lie outside
    except RockingError as error:
        sys.exit(f"rocking: {error}")
    os.chdir(folder)
    keep_inside(folder, store(), Path(os.environ["MPLCONFIGDIR"]))
    sys.argv[1:] = arguments[1:]
    run_module("rocking", run_name="__main__")


def keep_inside(*folders: Path) -> None:
    """Refuse to open files of this computer that are neither in one of the folders nor of the installation."""
    own = [sys.prefix, sys.base_prefix, sys.exec_prefix, *filter(None, sys.path), str(Path(__file__).parents[3])]
    allowed = tuple(f"{Path(each).resolve()}{os.sep}" for each in [*own, *_SYSTEM, *map(str, folders)])

    def look(event: str, details: tuple[Any, ...]) -> None:
        if event in {"subprocess.Popen", "os.posix_spawn", "os.exec"} and details[0] not in {None, sys.executable}:
            raise PermissionError(13, "a question starts no other program", str(details[0]))
        if event in {"os.system", "sqlite3.connect"}:
            raise PermissionError(13, "a question does no such thing", event)
        if event not in {"open", "os.listdir", "os.scandir"} or not isinstance(details[0], (str, bytes)):
            return
        path = os.path.realpath(os.fsdecode(details[0]))
        if not f"{path}{os.sep}".startswith(allowed):
            raise PermissionError(13, "not among the files that were sent", Path(path).name)

    sys.addaudithook(look)


def _limit() -> None:
    """Bound memory, time and files, where the system can."""
    os.nice(10) if hasattr(os, "nice") else None
    try:
        import resource
    except ImportError:
        return
    for which, most in ((resource.RLIMIT_AS, _MEMORY), (resource.RLIMIT_CPU, _SECONDS), (resource.RLIMIT_FSIZE, _FILE)):
        hard = resource.getrlimit(which)[1]
        least = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(which, (least, hard))


if __name__ == "__main__":
    main(sys.argv[1:])
