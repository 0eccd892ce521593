"""The Python API: one page per package, from `__all__` and the docstrings.

A name has one description, at its shortest path (`rocking.Block`); other packages that export the name link to it.
"""

import inspect
import shutil
from importlib import import_module
from pathlib import Path
from types import ModuleType

from sphinx.application import Sphinx
from sphinx.pycode import ModuleAnalyzer

ROOMS = {
    "rocking": "Main functions",
    "rocking.examples": "Examples",
    "rocking.bodies": "Bodies",
    "rocking.bodies.shapes": "Plane shapes",
    "rocking.bodies.solid": "Solids",
    "rocking.bodies.formats": "Body files",
    "rocking.motions": "Ground motions",
    "rocking.motions.pulses": "Pulses",
    "rocking.motions.synthetic": "Synthetic motions",
    "rocking.motions.formats": "Record files",
    "rocking.restitution": "Restitution models",
    "rocking.restitution.space": "Restitution models in 3D",
    "rocking.restitution.bed": "Contact bed",
    "rocking.dynamics": "Responses",
    "rocking.dynamics.plane_frictional": "Sliding, hopping and flight",
    "rocking.dynamics.rolling": "Responses in 3D",
    "rocking.studies": "Studies",
    "rocking.studies.fragility": "Fragility",
    "rocking.studies.sensitivity": "Sensitivity to the restitution model",
    "rocking.campaigns": "Campaigns",
    "rocking.campaigns.jobs": "Job files of campaigns",
    "rocking.evidence": "Measurements and evidence",
    "rocking.decision": "Decisions",
    "rocking.decision.prediction": "Predictions",
    "rocking.decision.assessment": "Assessments",
    "rocking.decision.inventory": "Inventories",
    "rocking.decision.code_methods": "Code checks",
    "rocking.statistics": "Statistics",
    "rocking.plots": "Pictures",
    "rocking.reports": "Reports",
    "rocking.tables": "Tables and result files",
    "rocking.errors": "Errors and warnings",
    "rocking.conventions": "Conventions and constants",
}
# base classes without a description of their members
BASES = (
    "object, BaseException, float, int, str, tuple, dict, Enum, StrEnum, IntEnum, AttributeError, ImportError, "
    "BaseModel"
)


def names_of(module: ModuleType) -> list[str]:
    """Return the exported names of a package, or all public names of a module without `__all__`."""
    if hasattr(module, "__all__"):
        return sorted(module.__all__)
    return sorted(
        key
        for key, value in vars(module).items()
        if not (key.startswith("_") or inspect.ismodule(value))
        and getattr(value, "__module__", module.__name__) == module.__name__
    )


def first_lines(value: object) -> str:
    """Return the summary of a docstring."""
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
    title = "Python API"
    (folder / "index.rst").write_text(
        f"{title}\n{'=' * len(title)}\n\n.. toctree::\n   :maxdepth: 1\n\n{rooms}\n", "utf-8"
    )


def constant(room: str, name: str, value: object) -> str:
    """Return the directive of a constant; without a comment of its own, its value, not the docstring of its type."""
    if ("", name) in ModuleAnalyzer.for_module(room).find_attr_docs():
        return f".. autodata:: {room}.{name}\n"
    return f".. py:data:: {name}\n   :value: {value!r:.80}\n"


def documented(path: str, value: object) -> str:
    """Return the directive of one name."""
    if inspect.isclass(value):
        return f".. autoclass:: {path}\n   :members:\n   :inherited-members: {BASES}\n"
    return f".. autofunction:: {path}\n"


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the pages before Sphinx reads them."""
    app.connect("builder-inited", lambda builder: write(Path(builder.srcdir) / "reference"))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
