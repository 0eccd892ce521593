"""The reference of Python: a page for each package and for each public name, from `__all__` and the docstrings.

A name is described once, where it is shortest (`rocking.Block`); other packages that export it refer to that page.
"""

import inspect
import shutil
from importlib import import_module
from pathlib import Path
from types import ModuleType

from sphinx.application import Sphinx
from sphinx.pycode import ModuleAnalyzer

ROOMS = {
    "rocking": "The front door",
    "rocking.examples": "Examples",
    "rocking.bodies": "Bodies",
    "rocking.bodies.shapes": "Shapes in the plane",
    "rocking.bodies.solid": "Solids",
    "rocking.bodies.formats": "Files of bodies",
    "rocking.motions": "Ground motions",
    "rocking.motions.pulses": "Pulses",
    "rocking.motions.synthetic": "Synthetic motions",
    "rocking.motions.formats": "Files of records",
    "rocking.restitution": "Models of restitution",
    "rocking.restitution.space": "Restitution in space",
    "rocking.restitution.bed": "The contact bed",
    "rocking.dynamics": "Responses",
    "rocking.dynamics.contact": "Sliding, hopping and flight",
    "rocking.dynamics.space": "Responses in space",
    "rocking.studies": "Studies",
    "rocking.studies.fragility": "Fragility",
    "rocking.studies.code_methods": "Code methods",
    "rocking.studies.inventory": "Inventories",
    "rocking.studies.sensitivity": "Sensitivity to the restitution",
    "rocking.campaigns": "Campaigns",
    "rocking.campaigns.jobs": "Jobs of campaigns",
    "rocking.evidence": "Evidence",
    "rocking.prediction": "Predictions",
    "rocking.assessment": "Assessments",
    "rocking.statistics": "Statistics",
    "rocking.plots": "Pictures",
    "rocking.reports": "Reports",
    "rocking.tables": "Tables and files of results",
    "rocking.errors": "Errors and warnings",
    "rocking.conventions": "Conventions and constants",
}
# whose members Python describes
BASES = (
    "object, BaseException, float, int, str, tuple, dict, Enum, StrEnum, IntEnum, AttributeError, ImportError, "
    "BaseModel"
)


def names_of(module: ModuleType) -> list[str]:
    """What a package exports, or all that a module without `__all__` defines."""
    if hasattr(module, "__all__"):
        return sorted(module.__all__)
    return sorted(
        key
        for key, value in vars(module).items()
        if not (key.startswith("_") or inspect.ismodule(value))
        and getattr(value, "__module__", module.__name__) == module.__name__
    )


def first_lines(value: object) -> str:
    """The summary of a docstring."""
    return (inspect.getdoc(value) or "").split("\n\n")[0].replace("\n", " ")


def write(folder: Path) -> None:
    """Write the pages into an empty folder."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    homes: dict[int, str] = {}
    for room, title in ROOMS.items():
        module = import_module(room)
        rows, described = [], []
        for name in names_of(module):
            value = getattr(module, name)
            if isinstance(value, ModuleType):
                rows += (
                    [f":py:mod:`{name} <{value.__name__}>`\n     - {first_lines(value)}"]
                    if value.__name__ in ROOMS
                    else []
                )
            elif not callable(value):
                described.append(constant(room, name, value))
            else:
                home = homes.setdefault(id(value), f"{room}.{name}")
                rows.append(f":py:obj:`{name} <{home}>`\n     - {first_lines(value)}")
                if home == f"{room}.{name}":
                    described.append(documented(home, value))
        table = "".join(f"   * - {row}\n" for row in rows)
        text = f"{title}\n{'=' * len(title)}\n\n.. py:module:: {room}\n\n``{room}``. {inspect.getdoc(module)}\n\n"
        text += f".. list-table::\n   :widths: 30 70\n\n{table}\n\n" + "\n".join(described)
        (folder / f"{room}.rst").write_text(text, "utf-8")
    rooms = "\n".join(f"   {title} <{room}>" for room, title in ROOMS.items())
    title = "Python reference"
    (folder / "index.rst").write_text(
        f"{title}\n{'=' * len(title)}\n\n.. toctree::\n   :maxdepth: 1\n\n{rooms}\n", "utf-8"
    )


def constant(room: str, name: str, value: object) -> str:
    """What asks for the words on a constant, or shows it where it has none: Python's on its type would stand there."""
    if ("", name) in ModuleAnalyzer.for_module(room).find_attr_docs():
        return f".. autodata:: {room}.{name}\n"
    return f".. py:data:: {name}\n   :value: {value!r:.80}\n"


def documented(path: str, value: object) -> str:
    """What asks for the documentation of one name."""
    if inspect.isclass(value):
        return f".. autoclass:: {path}\n   :members:\n   :inherited-members: {BASES}\n"
    return f".. autofunction:: {path}\n"


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the pages before Sphinx reads them."""
    app.connect("builder-inited", lambda each: write(Path(each.srcdir) / "reference"))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
