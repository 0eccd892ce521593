"""The directive `command`: lines that a user types, run when the manual is built, and what they print.

They run one after the other in a folder that the commands of a page share; `:show: FILE` shows a picture of theirs.
"""

import atexit
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path
from typing import ClassVar

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

WIDE = "100"  # columns of the terminal


@cache
def folder(page: str) -> Path:
    """Where the commands of a page run."""
    kept = Path(tempfile.mkdtemp(prefix=page.replace("/", "-")))
    atexit.register(shutil.rmtree, kept, ignore_errors=True)
    return kept


def printed(line: str, where: Path, status: int) -> str:
    """What a command prints; one that ends otherwise than it should is warned of, and a warning fails the build."""
    words = shlex.split(line)
    words[:1] = [sys.executable, "-m", "rocking"]
    environment = os.environ | {"COLUMNS": WIDE, "NO_COLOR": "1", "TERM": "dumb", "PYTHONWARNINGS": "ignore"}
    ran = subprocess.run(words, cwd=where, env=environment, capture_output=True, text=True, check=False)
    if ran.returncode != status:
        logging.getLogger(__name__).warning(
            "%s: status %d, not %d: %s", line, ran.returncode, status, ran.stderr or ran.stdout
        )
    return "\n".join(each.rstrip() for each in (ran.stdout + ran.stderr).splitlines())


class Command(SphinxDirective):
    """Commands, and what they print."""

    has_content = True
    option_spec: ClassVar = {"status": int, "hide-output": directives.flag, "show": str, "first": int}

    def run(self) -> list[nodes.Node]:
        """Return a block of what is typed, each with its output."""
        lines = []
        for line in self.content:
            output = printed(line, folder(self.env.docname), self.options.get("status", 0))
            if "first" in self.options and len(output.splitlines()) > self.options["first"]:
                output = "\n".join([*output.splitlines()[: self.options["first"]], "..."])
            lines += [f"$ {line}"] + ([output, ""] if output and "hide-output" not in self.options else [])
        text = "\n".join(lines).rstrip()
        return [nodes.literal_block(text, text, language="console"), *self.picture()]

    def picture(self) -> list[nodes.Node]:
        """Return the picture that is to be shown."""
        if "show" not in self.options:
            return []
        kept = Path(self.env.srcdir) / "pictures" / f"{self.env.docname.replace('/', '-')}-{self.options['show']}"
        kept.parent.mkdir(exist_ok=True)
        if not (folder(self.env.docname) / self.options["show"]).exists():  # its command was warned of
            return []
        shutil.copyfile(folder(self.env.docname) / self.options["show"], kept)
        self.env.note_dependency(str(kept))  # a page whose picture is gone is read again
        return [nodes.image(uri=f"/pictures/{kept.name}", alt=f"{self.options['show']}, which the command wrote")]


def setup(app: Sphinx) -> dict[str, bool]:
    """Tell Sphinx."""
    app.add_directive("command", Command)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
