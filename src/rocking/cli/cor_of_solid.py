"""`rocking cor` of a body in space: from the options to what is printed."""

from pathlib import Path
from typing import Any

from rocking.cli import solid_cor_output
from rocking.cli.files_output import check_files
from rocking.cli.solid_impact import SolidAnswer
from rocking.cli.solid_options import refuse, solid_from, spelt
from rocking.conventions import g


def answer(
    body: Path,
    size: dict[str, Any],
    told: dict[str, Any],
    asked: dict[str, Any],
    files: dict[str, Path | None],
    *,
    models: list[str] | None,
    gravity: float | None,
    as_json: bool,
) -> None:
    """Print, write and draw the coefficients of a body in space.

    Parameters
    ----------
    body : Path
        TOML file with [solid], or a mesh.
    size : dict
        Options that say a plane body, which are refused.
    told : dict
        ``unit``, ``density``, ``up``, ``fill_holes`` and ``base_tolerance`` of a mesh.
    asked : dict
        ``onto``, ``eta`` and ``identities`` of a plane body, which are refused.
    files : dict
        ``csv``, ``picture``, and ``stages``, which is refused.
    models : list of str, optional
        Models in space.
    gravity : float, optional
        Acceleration of gravity; the standard one if not given [m/s2].
    as_json : bool
        Whether to print JSON.
    """
    refuse("a body in space has its size from its file", spelt(size))
    plane = {
        "--onto": None if asked["onto"] == "both" else asked["onto"],
        "--eta": None if asked["eta"] == 1.0 else asked["eta"],
        "--identities": asked["identities"],
        "--stages": files["stages"],
    }
    refuse("a body in space rocks about every edge of its base", plane)
    csv, picture = files["csv"], files["picture"]
    check_files(picture, csv)
    found = SolidAnswer.of(solid_from(body, **told), models, g if gravity is None else gravity)
    if csv is not None:
        solid_cor_output.write_csv(found, csv)
    if picture is not None:
        solid_cor_output.draw(found.file, picture)
    if as_json:
        print(solid_cor_output.as_json(found))
        return
    solid_cor_output.show(found)
    for path in filter(None, (csv, picture)):
        print(f"wrote {path}")
