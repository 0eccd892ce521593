"""Number of files of the package in the call path of a question."""

import json
import subprocess
import sys
import tempfile

_FOLLOW = """
import sys
import threading
from pathlib import Path
import rocking
ROOT = str(Path(rocking.__file__).parent)
passed = set()

def importing(frame):
    while frame := frame.f_back:
        if frame.f_code.co_name == "<module>" and frame.f_code.co_filename.startswith(ROOT):
            return True
    return False

def follow(frame, event, argument):
    code = frame.f_code
    # the body of a class or module is no call (it has no locals of its own), nor what a module does once, when imported
    if event == "call" and code.co_flags & 1 and code.co_filename.startswith(ROOT) and not importing(frame):
        passed.add(code.co_filename)

BEFORE
threading.setprofile(follow)
sys.setprofile(follow)
ASKED
sys.setprofile(None)
import json
print("FOLLOWED", json.dumps(sorted(passed)))
"""
_QUIET = """
import contextlib, io
from rocking.cli import main
with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit):
    main({words!r})"""
_MAP = (
    "map --width 1 --height 4 --motion sine:amplitude=3,period=0.8 --x frequency_ratio=2:8:6 --y amplitude_ratio=1:8:6"
)
_RUN, _EXPORT = "campaign run job.toml --output c --workers 1", "campaign export c --output result.nc"
_JOB = """
[campaign]
name = "map"
kind = "overturning-map"
[body]
units = "m"
width = 0.5
height = 2.0
[motions]
pulse = "sine:amplitude=3,period=0.6"
[restitution]
models = ["ked"]
[map]
x = {axis = "frequency_ratio", from = 1, to = 6, count = 3}
y = {axis = "amplitude_ratio", from = 1, to = 8, count = 3}
"""
_PAGE = """
from pathlib import Path
from fastapi.testclient import TestClient
from rocking_workbench.application import create_app
from rocking_workbench.settings import ServerSettings
settings = ServerSettings(folder=Path("."), workers=1)
app = create_app(settings)
head = {"Authorization": f"Bearer {app.state.rocking.sessions.key}", "Origin": settings.origin}
client = TestClient(app, base_url=settings.origin, headers=head)
body, motion = {"units": "m", "width": 0.5, "height": 2.0}, {"pulse": "sine:amplitude=4,period=0.8"}
"""
_ASK = "client.post('/api/response', json={'body': body, 'motion': motion, 'restitution': {'models': ['ked']}})"
QUESTIONS = {
    "simulate": (
        "import rocking as rk\n"
        "block = rk.Block(width=1.0, height=4.0)\nmotion = rk.pulses.sine(amplitude=4.0, period=0.8)",
        "rk.simulate(block, motion)",
        12,
    ),
    "a map by command": ("", _QUIET.format(words=_MAP.split()), 18),
    "campaign export": (
        f"open('job.toml', 'w').write({_JOB!r})\n" + _QUIET.format(words=_RUN.split()),
        _QUIET.format(words=_EXPORT.split()),
        25,
    ),
    "POST response": (_PAGE, _ASK, 16),
}


def followed(before: str, asked: str) -> list[str]:
    """Return the files of the package in which a function was called."""
    script = _FOLLOW.replace("BEFORE", before).replace("ASKED", asked)
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True, cwd=folder)
    line = next(text for text in done.stdout.splitlines() if text.startswith("FOLLOWED"))
    return json.loads(line.removeprefix("FOLLOWED "))


def files_passed() -> list[tuple[str, int, int]]:
    """Return each question, the files in its path, and their largest allowed number."""
    return [
        (description, len(followed(before, asked)), most) for description, (before, asked, most) in QUESTIONS.items()
    ]
