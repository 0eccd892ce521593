"""`rocking cor` of a body in space: from the options to what is printed."""

import json
from pathlib import Path
from typing import Any

from rocking.bodies.solid import RoundBase
from rocking.cli import solid_cor_output
from rocking.cli.files_output import check_files
from rocking.cli.solid_impact import SolidAnswer
from rocking.cli.solid_options import refuse, solid_from, spelt
from rocking.conventions import g

ROUND_BASE = (
    "a round base rolls round its rim and has no impact in one plane: these values hold only if the body is held to "
    "one vertical plane, and must not be used for one that is free; `rocking simulate` follows it as it rolls"
)
"""What must be known before a plane coefficient of a round base is used."""


def notes(found: SolidAnswer) -> list[str]:
    """Return what limits the use of the coefficients.

    Returns one sentence each; none for a base with corners.
    """
    return [ROUND_BASE] if isinstance(found.file.solid.base, RoundBase) else []


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

    body: TOML file with [solid], or a mesh; gravity: acceleration of gravity; the standard one if not given [m/s2].
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
        facts = json.loads(solid_cor_output.as_json(found))
        print(json.dumps({**facts, "notes": notes(found)}, indent=2, allow_nan=False))
        return
    solid_cor_output.show(found, told["unit"] or "m")
    for sentence in notes(found):
        print(f"! {sentence}")
    for path in filter(None, (csv, picture)):
        print(f"wrote {path}")
