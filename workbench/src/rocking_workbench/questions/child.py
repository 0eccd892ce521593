"""A command that a server runs: `python -m rocking_workbench.questions.child`.

The process loads common modules until it reads a line with a folder and the arguments of a command. Then the process
runs `rocking COMMAND ARGUMENTS ...` in this folder with limits, and opens only files in the folder. The process ends
with the server, because its standard input is a pipe.
"""

import json
import os
import sys
import tempfile
import threading
from importlib import import_module
from pathlib import Path
from runpy import run_module
from typing import Any

_MEMORY, _SECONDS, _FILE = 8 << 30, 1800, 512 << 20  # limits: memory [bytes], CPU time [s], file size [bytes]
_COMMON = (
    "typer", "rocking.spec.documents.prediction", "rocking.decision.prediction", "rocking.spec.construction",
    "rocking.bodies.formats", "rocking.restitution.from_file", "matplotlib.backends.backend_pdf",
    "matplotlib.backends.backend_svg", "scipy.signal", "rocking.plots.style", "trimesh", "rocking.reports",
)  # fmt: skip
"""Common modules, which a process loads before it has a command."""
_SYSTEM = ("/usr", "/lib", "/lib64", "/opt", "/proc", "/sys", "/dev", "/etc/fonts", "/etc/localtime", "/etc/mime.types")


def main() -> None:
    """Run the received command."""
    from rocking_workbench.runs.process import end_with_the_server

    received, question = threading.Event(), b""

    def listen() -> None:
        nonlocal question
        while not question.endswith(b"\n"):
            if not (byte := os.read(0, 1)):
                os._exit(0)  # the server has ended without a command
            question += byte
        received.set()
        end_with_the_server()

    threading.Thread(target=listen, daemon=True).start()
    _limit()
    for module in _COMMON:
        if not received.is_set():
            import_module(module)
    received.wait()
    _answer(**json.loads(question))


def _answer(folder: str, file: str, answer: str, log: str, own: str, arguments: list[str]) -> None:
    """Run a command in a folder; answer, log and output of libraries are files in this folder."""
    os.chdir(folder)
    for number, name in ((1, answer), (2, log)):
        descriptor = os.open(name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
        os.dup2(descriptor, number)
        os.close(descriptor)
    os.environ["TMPDIR"] = tempfile.tempdir = str(Path(own).resolve())
    from rocking.errors import RockingError
    from rocking.evidence.store import store
    from rocking.restitution.from_file import register_own

    try:
        register_own()  # the user's models, which are outside the folder
    except RockingError as error:
        sys.stderr.write(json.dumps({"error": error.data()}))
        sys.exit(2)
    models = os.environ.get("ROCKING_MODELS")  # the command reads this file again
    keep_inside(Path.cwd(), store(), Path(os.environ["MPLCONFIGDIR"]), *([Path(models)] if models else []))
    sys.argv[1:] = arguments
    run_module("rocking", {"unnamed_file": file}, "__main__")


def keep_inside(*folders: Path) -> None:
    """Refuse to open files outside the folders and the installation."""
    own = [sys.prefix, sys.base_prefix, sys.exec_prefix, *filter(None, sys.path), str(Path(__file__).parents[2])]
    allowed = tuple(f"{Path(folder).resolve()}{os.sep}" for folder in [*own, *_SYSTEM, *map(str, folders)])

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
    """Limit memory, time and file size, if the system supports limits."""
    try:
        import resource
    except ImportError:
        return
    for which, most in ((resource.RLIMIT_AS, _MEMORY), (resource.RLIMIT_CPU, _SECONDS), (resource.RLIMIT_FSIZE, _FILE)):
        hard = resource.getrlimit(which)[1]
        limit = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(which, (limit, hard))


if __name__ == "__main__":
    main()
