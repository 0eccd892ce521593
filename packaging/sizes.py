"""What the core of the package takes on disk: the table of docs/install.md, by the Python that has it installed."""

import re
from importlib.metadata import Distribution, distribution, requires

_NAME = re.compile(r"[\w.-]+")


def megabytes(name: str) -> float:
    """Size of what a distribution installed, without the code that Python compiles when it runs [MB]."""
    files = [file for file in distribution(name).files or () if file.suffix != ".pyc"]
    return sum(path.stat().st_size for file in files if (path := file.locate()).is_file()) / 1e6  # type: ignore[union-attr]


def needed(name: str) -> list[str]:
    """Distributions that one needs here, itself first, each once."""
    found: list[str] = []
    waiting = [name]
    while waiting:
        one = waiting.pop(0).lower().replace("_", "-")
        if one in found or not _is_here(one):
            continue
        found.append(one)
        waiting += [_NAME.match(line)[0] for line in requires(one) or () if "extra ==" not in line]  # type: ignore[index]
    return found


def _is_here(name: str) -> bool:
    return next(iter(Distribution.discover(name=name)), None) is not None


def rows() -> list[tuple[str, float, dict[str, float]]]:
    """Dependencies of the core in their order: name, size, and what each is the first to bring, with its size [MB]."""
    core = [_NAME.match(line)[0] for line in requires("rocking") or () if "extra ==" not in line]  # type: ignore[index]
    counted = set(core)
    table = []
    for name in core:
        brought = [each for each in needed(name)[1:] if each not in counted]
        counted |= set(brought)
        table.append((name, megabytes(name), {each: megabytes(each) for each in brought}))
    return table


if __name__ == "__main__":
    found = rows()
    for name, size, brought in found:
        print(f"{name:<12} {size:6.1f} MB ", ", ".join(f"{each} {more:.1f}" for each, more in brought.items()))
    total = sum(size + sum(brought.values()) for _, size, brought in found)
    print(f"{'rocking':<12} {megabytes('rocking'):6.1f} MB\nall together {total + megabytes('rocking'):.0f} MB")
