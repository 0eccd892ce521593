"""`rocking simulate` of pure rocking: from the options, or the file that says everything, to what is printed."""

from rocking.cli import simulate_document, simulate_json, simulate_page
from rocking.cli.simulate_asked import SimulateOptions
from rocking.cli.simulate_output import ResponseComparison, ResponseFiles
from rocking.cli.solid_options import refuse


def answer(asked: SimulateOptions, files: ResponseFiles, *, as_json: bool) -> None:
    """Print, write and draw how a plane body rocks without sliding."""
    if asked.document is not None:
        found = simulate_document.answer_of(asked.document)
    else:
        refuse("pure rocking does not leave the ground: with --contact it may", asked.only_typed(("bounce",)))
        found = ResponseComparison.of(asked.question(), asked.values["restitution"])
    written = files.write(found)
    if as_json:
        print(simulate_json.as_json(found))
        return
    simulate_page.show(found, *asked.units)
    for path in written:
        print(f"wrote {path}")
