"""Disk space of the core of the package: the table of docs/install.md, from the installed distributions."""

import re
from importlib.metadata import Distribution, distribution, requires

_NAME = re.compile(r"[\w.-]+")


def megabytes(name: str) -> float:
    """Return the size of an installed distribution, without compiled bytecode [MB]."""
    files = [file for file in distribution(name).files or () if file.suffix != ".pyc"]
    return sum(path.stat().st_size for file in files if (path := file.locate()).is_file()) / 1e6  # type: ignore[union-attr]


def needed(name: str) -> list[str]:
    """Distributions that one needs here, itself first, each once."""
    names: list[str] = []
    waiting = [name]
    while waiting:
        distribution_name = waiting.pop(0).lower().replace("_", "-")
        if distribution_name in names or not _is_here(distribution_name):
            continue
        names.append(distribution_name)
        waiting += [_NAME.match(line)[0] for line in requires(distribution_name) or () if "extra ==" not in line]  # type: ignore[index]
    return names


def _is_here(name: str) -> bool:
    return next(iter(Distribution.discover(name=name)), None) is not None


def rows() -> list[tuple[str, float, dict[str, float]]]:
    """Return the dependencies of the core: name, size, additional dependencies with sizes [MB]."""
    core = [_NAME.match(line)[0] for line in requires("rocking") or () if "extra ==" not in line]  # type: ignore[index]
    counted = set(core)
    table = []
    for name in core:
        brought = [dependency for dependency in needed(name)[1:] if dependency not in counted]
        counted |= set(brought)
        table.append((name, megabytes(name), {dependency: megabytes(dependency) for dependency in brought}))
    return table


if __name__ == "__main__":
    table = rows()
    for name, size, brought in table:
        print(
            f"{name:<12} {size:6.1f} MB ", ", ".join(f"{dependency} {more:.1f}" for dependency, more in brought.items())
        )
    total = sum(size + sum(brought.values()) for _, size, brought in table)
    print(f"{'rocking':<12} {megabytes('rocking'):6.1f} MB\nall together {total + megabytes('rocking'):.0f} MB")
