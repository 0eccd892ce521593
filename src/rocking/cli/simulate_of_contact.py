"""`rocking simulate --contact`: from the options to what is printed."""

from typing import Any

from rocking.cli import contact_page
from rocking.cli.files_output import check_files
from rocking.cli.simulate_asked import SimulateOptions
from rocking.cli.simulate_output import ResponseFiles
from rocking.cli.solid_options import refuse
from rocking.dynamics.planar import PlanarResponse
from rocking.errors import InvalidValueError


def answer(asked: SimulateOptions, files: ResponseFiles, *, as_json: bool) -> None:
    """Print, write and draw what a plane body does that may slide and hop."""
    if asked.document is not None:
        raise InvalidValueError(f"{asked.document} has a table [response] and says everything itself: no --contact")
    refuse("--contact has one engine, with the full equations", asked.only_typed(("linear", "engine", "animation")))
    check_files(files.picture, files.csv, files.mat, files.netcdf)
    bounce = asked.values["bounce"]
    response = contact_page.contact_response(
        asked.question(), asked.values["restitution"], 0.0 if bounce is None else bounce
    )
    written = files.written(response, lambda: _drawn(response))
    if as_json:
        print(contact_page.as_json(response))
        return
    contact_page.show(response, asked.units[0])
    for path in written:
        print(f"wrote {path}")


def _drawn(response: PlanarResponse) -> Any:
    from rocking.plots.regimes import regimes_picture

    return regimes_picture(response)
