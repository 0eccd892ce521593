"""Tables of goals: measured values, required values, and the machine."""

import os
import platform
from importlib import metadata
from pathlib import Path
from typing import NamedTuple


class Row(NamedTuple):
    """One line: met is None where there was no goal, or nothing to measure with."""

    what: str
    against: str
    measured: str
    goal: str
    met: bool | None = None


def lines(rows: list[Row]) -> list[str]:
    """The table in Markdown."""
    word = {True: "yes", False: "NO", None: "-"}
    head = ["| what | against | measured | goal | met |", "|---|---|---|---|---|"]
    return head + [f"| {a} | {b} | {c} | {d} | {word[met]} |" for a, b, c, d, met in rows]


def keep(name: str, text: list[str]) -> None:
    """Print a page and store it in the folder of the benchmarks."""
    print("\n".join(text), flush=True)
    (Path(__file__).parent / name).write_text("\n".join(text) + "\n", encoding="utf-8")


def machine() -> str:
    """Processor, its vector instructions, cores."""
    model, flags = platform.processor() or platform.machine(), set()
    info = Path("/proc/cpuinfo")
    if info.exists():
        entries = dict(line.split(":", 1) for line in info.read_text(encoding="utf-8").splitlines() if ":" in line)
        fields = {key.strip(): value.strip() for key, value in entries.items()}
        flags = set(fields.get("flags", "").split())
        family = f"family {fields.get('cpu family', '?')} model {fields.get('model', '?')}"
        model = f"{fields.get('model name', model)} ({family}, {fields.get('cache size', '?')} cache)"
    vectors = ", ".join(name for name in ("avx512f", "avx512dq", "avx2", "fma", "asimd") if name in flags)
    return f"{model}; {vectors or 'vector instructions unknown'}; {os.cpu_count()} cores; {platform.system()}"


def versions(*names: str) -> str:
    """Return the versions of the installed packages among some."""
    texts = [f"Python {platform.python_version()}"]
    for name in names:
        try:
            texts.append(f"{name} {metadata.version(name)}")
        except metadata.PackageNotFoundError:
            texts.append(f"{name} not installed")
    return ", ".join(texts)
