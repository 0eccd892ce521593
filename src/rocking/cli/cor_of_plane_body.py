"""`rocking cor` of a plane body: from the options to what is printed."""

from pathlib import Path
from typing import Any

from rocking.cli import cor_output
from rocking.cli.body_options import body_from
from rocking.cli.model_options import models_from
from rocking.cli.solid_options import refuse, spelt
from rocking.conventions import g
from rocking.report.facts.impact import ImpactAnswer


def answer(
    body: Path | None,
    size: dict[str, Any],
    mesh: dict[str, Any],
    asked: dict[str, Any],
    files: dict[str, Path | None],
    *,
    models: list[str] | None,
    gravity: float | None,
    as_json: bool,
) -> None:
    """Print, write and draw the coefficients of a plane body.

    Parameters
    ----------
    body : Path, optional
        Body file.
    size : dict
        Options that say the body in place of a file.
    mesh : dict
        Options for meshes, which are refused.
    asked : dict
        ``onto``, ``eta`` and ``identities``.
    files : dict
        ``csv``, ``picture`` and ``stages``.
    models : list of str, optional
        Models.
    gravity : float, optional
        Acceleration of gravity; the standard one if not given [m/s2].
    as_json : bool
        Whether to print JSON.
    """
    refuse("a plane body is no mesh", spelt(mesh))
    found = ImpactAnswer.of(
        body_from(body, **size), models_from(models), gravity=g if gravity is None else gravity, **asked
    )
    csv, picture, stages = files["csv"], files["picture"], files["stages"]
    if csv is not None:
        cor_output.write_csv(found, csv)
    if picture is not None:
        cor_output.draw(found, picture)
    if stages is not None:
        cor_output.draw_stages(found, stages)
    if as_json:
        print(cor_output.as_json(found))
        return
    cor_output.show(found)
    for path in filter(None, files.values()):
        print(f"wrote {path}")
