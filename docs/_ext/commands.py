"""The pages of the command line: commands that run when the manual is built, and options as the parser has them.

`command` runs commands in one folder per page and shows their output; `:show: FILE` shows a picture.
`command-options` lists the arguments and options of a command; `command-list` lists all commands in their groups.
"""

import atexit
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, ClassVar

import typer
from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

WIDE = "100"  # columns of the terminal
_GROUPS = ["Assess", "Respond", "Restitution", "Records", "Run"]  # order of the groups
_LOG = logging.getLogger(__name__)


@cache
def folder(page: str) -> Path:
    """Return the folder in which the commands of a page run."""
    kept = Path(tempfile.mkdtemp(prefix=page.replace("/", "-")))
    atexit.register(shutil.rmtree, kept, ignore_errors=True)
    return kept


def printed(line: str, where: Path, status: int) -> str:
    """Return the output of a command; another exit code than `status` is a warning, which fails the build."""
    arguments = shlex.split(line)
    arguments[:1] = [sys.executable, "-m", "rocking"]
    environment = os.environ | {"COLUMNS": WIDE, "NO_COLOR": "1", "TERM": "dumb", "PYTHONWARNINGS": "ignore"}
    ran = subprocess.run(arguments, cwd=where, env=environment, capture_output=True, text=True, check=False)
    if ran.returncode != status:
        _LOG.warning("%s: status %d, not %d: %s", line, ran.returncode, status, ran.stderr or ran.stdout)
    return "\n".join(row.rstrip() for row in (ran.stdout + ran.stderr).splitlines())


class Command(SphinxDirective):
    """Commands and their output."""

    has_content = True
    option_spec: ClassVar = {"status": int, "hide-output": directives.flag, "show": str, "first": int}

    def run(self) -> list[nodes.Node]:
        """Return a block with each command line and its output."""
        lines = []
        for line in self.content:
            output = printed(line, folder(self.env.docname), self.options.get("status", 0))
            if "first" in self.options and len(output.splitlines()) > self.options["first"]:
                output = "\n".join([*output.splitlines()[: self.options["first"]], "..."])
            lines += [f"$ {line}"] + ([output, ""] if output and "hide-output" not in self.options else [])
        text = "\n".join(lines).rstrip()
        return [nodes.literal_block(text, text, language="console"), *self.picture()]

    def picture(self) -> list[nodes.Node]:
        """Return the picture of the option `show`."""
        if "show" not in self.options:
            return []
        kept = Path(self.env.srcdir) / "pictures" / f"{self.env.docname.replace('/', '-')}-{self.options['show']}"
        kept.parent.mkdir(exist_ok=True)
        if not (folder(self.env.docname) / self.options["show"]).exists():  # its command was warned of
            return []
        shutil.copyfile(folder(self.env.docname) / self.options["show"], kept)
        self.env.note_dependency(str(kept))  # a page whose picture is gone is read again
        return [nodes.image(uri=f"/pictures/{kept.name}", alt=f"Picture of the command: {self.options['show']}")]


@cache
def parser() -> Any:
    """Return the parser of all commands."""
    from rocking.cli.application import application

    return typer.main.get_command(application())


def subcommands(command: Any) -> dict[str, Any]:
    """Return the visible subcommands of a command by name."""
    inner = getattr(command, "commands", {})
    return {name: value for name, value in inner.items() if not value.hidden}


def plain(text: str | None) -> str:
    """Return a help text without the marks of the terminal, as Markdown."""
    unmarked = re.sub(r"\[/?(?:dim|bold|italic|cyan|yellow|green|red)\]", "", (text or "").replace("\\[", "["))
    return " ".join(re.sub(r"([*_<>|])", r"\\\1", unmarked).split())


def rows_of(command: Any) -> Iterator[tuple[str, str, str, str, str]]:
    """Yield group, name, value, default and help of the visible arguments and options of a command."""
    for parameter in command.params:
        if parameter.name in {"help", "install_completion", "show_completion"}:
            continue
        argument = parameter.param_type_name == "argument"
        names = [parameter.name.upper()] if argument else [*parameter.opts, *parameter.secondary_opts]
        repeated = "..." if getattr(parameter, "multiple", False) or parameter.nargs == -1 else ""
        yield (
            getattr(parameter, "rich_help_panel", None) or ("Arguments" if argument else "Options"),
            ", ".join(f"`{name}`" for name in names),
            "" if getattr(parameter, "is_flag", False) else f"{_kind(parameter)}{repeated}",
            _default(parameter),
            plain(parameter.help),
        )


def _kind(parameter: Any) -> str:
    kind = parameter.metavar or getattr(parameter.type_descriptor.annotation, "__name__", "text")
    return {"str": "text", "int": "integer", "float": "number", "list": "text"}.get(kind, kind.lower())


def _default(parameter: Any) -> str:
    default = parameter.default
    return "" if default is None or default is False or callable(default) else f"`{default}`"


class CommandOptions(SphinxDirective):
    """Usage, arguments and options of a command, from the parser."""

    required_arguments = 1
    final_argument_whitespace = True

    def run(self) -> list[nodes.Node]:
        """Return the usage and one table for each group of options."""
        command = parser()
        for name in self.arguments[0].split():
            if name not in subcommands(command):
                _LOG.warning("%s: no command '%s'", self.env.docname, self.arguments[0], location=self.get_location())
                return []
            command = subcommands(command)[name]
        groups = defaultdict(list)
        for group, *row in rows_of(command):
            groups[group].append(row)
        usage = " ".join(f"[{p.name.upper()}]" for p in command.params if p.param_type_name == "argument")
        lines = [
            f"{plain(command.help or command.short_help)}",
            "",
            "```",
            f"rocking {self.arguments[0]} {usage} [OPTIONS]".replace("  ", " "),
            "```",
        ]
        for group, rows in groups.items():
            lines += ["", f"**{plain(group)}**", "", "| name | value | default | meaning |", "|---|---|---|---|"]
            lines += ["| " + " | ".join(row) + " |" for row in rows]
        return self.parse_text_to_nodes("\n".join(lines))


class CommandList(SphinxDirective):
    """All commands in the groups of the parser, each with its page; a command without a page is a warning."""

    def run(self) -> list[nodes.Node]:
        """Return one table for each group."""
        groups = defaultdict(list)
        for name, command in subcommands(parser()).items():
            if f"commands/{name}" not in self.env.found_docs:
                _LOG.warning("no page of the command '%s' in docs/commands", name, location=self.get_location())
                continue
            panel = getattr(command, "rich_help_panel", None)
            group = panel if isinstance(panel, str) else "Commands"
            groups[group].append(f"| [`rocking {name}`]({name}.md) | {plain(command.short_help or command.help)} |")
        lines: list[str] = []
        for group, rows in sorted(groups.items(), key=lambda entry: [*_GROUPS, entry[0]].index(entry[0])):
            lines += [f"**{group}**", "", "| command | purpose |", "|---|---|", *rows, ""]
        return self.parse_text_to_nodes("\n".join(lines))


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directives."""
    app.add_directive("command", Command)
    app.add_directive("command-options", CommandOptions)
    app.add_directive("command-list", CommandList)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
