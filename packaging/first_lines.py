"""Try an installation as somebody does who has just made it: the first lines of README, and three commands.

``python first_lines.py README.md [--without-engine]`` in an empty folder, by the Python that has the package.
"""

import re
import subprocess
import sys
from pathlib import Path

COMMANDS = (
    "restitution --width 1 --height 4",
    "simulate --width 0.5 --height 2 --motion sine:amplitude=3,period=0.8 --restitution ked --output r.png",
    "examples statue",
)
_TOLD = re.compile(r"\s*(?:(\d\.\d+):|\"(.+)\"$)")  # a number or a text at the beginning of a comment is the answer


def main(readme: str, *options: str) -> None:
    """Run all lines, and stop at a result that differs from README."""
    block = re.search(r"```python\n(.*?)```", Path(readme).read_text("utf-8"), re.DOTALL)
    assert block is not None, f"{readme} has no Python in it"
    names: dict[str, object] = {}
    checked = 0
    for line in block[1].splitlines():
        code, _, comment = line.partition("#")
        match = _TOLD.match(comment)
        if match is None:
            exec(code, names)
            continue
        value, (number, description) = eval(code, names), match.groups()
        assert value == description if description else f"{value:.{len(number) - 2}f}" == number, (line, value)
        checked += 1
    assert checked, f"{readme} says of no line what it gives"
    from rocking.dynamics.plane import fast_engine

    assert fast_engine.available() is ("--without-engine" not in options), "an engine was or was not expected"
    for command in COMMANDS:
        subprocess.run([sys.executable, "-m", "rocking", *command.split()], check=True, stdout=subprocess.DEVNULL)
    assert Path("r.png").read_bytes().startswith(b"\x89PNG")
    print(f"{checked} answers of {readme} and {len(COMMANDS)} commands, on Python {sys.version.split()[0]}")


if __name__ == "__main__":
    main(*sys.argv[1:])
