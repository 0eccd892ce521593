"""`rocking cor` of a plane body: from the options to what is printed."""

import sys
from pathlib import Path
from typing import Any

from rocking.bodies import Body
from rocking.cli import cor_output
from rocking.cli.body_options import body_from
from rocking.cli.model_options import models_from
from rocking.cli.solid_options import refuse, spelt
from rocking.conventions import g
from rocking.report.facts.impact import ImpactAnswer
from rocking.spec.reading import is_response


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

    gravity: acceleration of gravity; that of the file or the standard one if not given [m/s2].
    """
    refuse("a plane body is no mesh", spelt(mesh))
    made, stated = _body(body, size, as_json=as_json)
    chosen = next((one for one in (gravity, stated) if one is not None), g)
    found = ImpactAnswer.of(made, models_from(models), gravity=chosen, **asked)
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
    cor_output.show(found, size["unit"] or "m")
    for path in filter(None, files.values()):
        print(f"wrote {path}")


def _body(file: Path | None, size: dict[str, Any], *, as_json: bool) -> tuple[Body, float | None]:
    """Return the body, and the gravity of a file that says a whole response; JSON stays alone on its stream."""
    if file is None or not is_response(file):
        return body_from(file, **size), None
    from rocking.cli import cor_of_document  # it loads what reads job files

    print(cor_of_document.sentence(file), file=sys.stderr if as_json else sys.stdout)
    return cor_of_document.body_and_gravity(file, size)
