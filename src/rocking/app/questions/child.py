"""The process of a question: `python -m rocking.app.questions.child FOLDER COMMAND FILE ...`.

It runs a command on the question in its folder, as `rocking COMMAND question.toml --json --out FILE ...` does, with
limits, and opens nothing that was not sent. It ends when the server does: its standard input is a pipe.
"""

import os
import sys
import threading
from pathlib import Path
from typing import Any

_MEMORY, _SECONDS, _FILE = 8 << 30, 1800, 512 << 20  # limits: memory [bytes], time of processors [s], a file [bytes]
_SYSTEM = ("/usr", "/lib", "/lib64", "/opt", "/proc", "/sys", "/dev", "/etc/fonts", "/etc/localtime", "/etc/mime.types")
QUESTION = "question.toml"


def main(arguments: list[str]) -> None:
    """Answer a question."""
    from rocking.app.studies.child import end_with_the_server

    folder, command, outputs = Path(arguments[0]).resolve(), arguments[1], arguments[2:]
    threading.Thread(target=end_with_the_server, daemon=True).start()
    _limit()
    os.chdir(folder)
    from rocking.cli import main as command_line
    from rocking.evidence.store import store

    keep_inside(folder, store(), Path(os.environ["MPLCONFIGDIR"]))
    command_line([command, QUESTION, "--json", *(word for name in outputs for word in ("--out", name))])


def keep_inside(*folders: Path) -> None:
    """Refuse to open files of this computer that are neither in one of the folders nor of the installation."""
    own = [sys.prefix, sys.base_prefix, sys.exec_prefix, *filter(None, sys.path), str(Path(__file__).parents[3])]
    allowed = tuple(f"{Path(each).resolve()}{os.sep}" for each in [*own, *_SYSTEM, *map(str, folders)])

    def look(event: str, details: tuple[Any, ...]) -> None:
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
