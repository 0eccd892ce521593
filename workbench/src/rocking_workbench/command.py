"""The command `rocking serve`: start the application and open it in a browser."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from rocking_workbench.server import Started
    from rocking_workbench.settings import ServerSettings


def serve(
    port: Annotated[int | None, typer.Option(help="Port. [default: 8765 or the next free port]")] = None,
    host: Annotated[str, typer.Option(help="Address of the server.")] = "127.0.0.1",
    allow_remote: Annotated[bool, typer.Option("--allow-remote", help="Access from other machines.")] = False,
    data: Annotated[Path | None, typer.Option(help="Folder of records and studies.")] = None,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="No browser window; link only.")] = False,
    workers: Annotated[int | None, typer.Option(help="Number of processes of a study.", min=1, max=1024)] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Output in JSON format.")] = False,
) -> None:
    """Start the web application on this machine."""
    from rocking.evidence.store import data_folder
    from rocking_workbench.settings import ServerSettings

    settings = ServerSettings(
        host=host, folder=(data or data_folder()).expanduser().absolute(), allow_remote=allow_remote, workers=workers
    )
    _serve(settings, port, quiet=no_browser or as_json, as_json=as_json)


def _serve(settings: "ServerSettings", port: int | None, *, quiet: bool, as_json: bool) -> None:
    from rocking.errors import MissingExtraError, how_to_install

    try:
        from rocking_workbench.server import FolderInUseError
        from rocking_workbench.server import serve as run
    except ImportError as error:
        if isinstance(error, MissingExtraError) or (error.name or "rocking").startswith("rocking"):
            raise
        raise MissingExtraError(how_to_install("the application", "fastapi", error)) from error

    def started(server: "Started") -> None:
        _show(server, as_json=as_json)
        if not quiet:
            _open(server.link)

    try:
        run(settings, started, port=port)
    except FolderInUseError:
        if port is not None or as_json or not _join(settings, quiet=quiet):
            raise
    else:
        if not as_json:
            print("stopped; results are kept")


def _show(server: "Started", *, as_json: bool) -> None:
    import json

    if as_json:
        facts = {"url": server.url, "token": server.token, "port": server.port, "key_file": str(server.key_file)}
        print(json.dumps(facts), flush=True)
    else:
        print(f"{server.link}   (works once; Ctrl-C stops the server)", flush=True)


def _open(link: str) -> None:
    import threading
    import webbrowser

    threading.Thread(target=webbrowser.open, args=(link,), daemon=True).start()


def _join(settings: "ServerSettings", *, quiet: bool) -> bool:
    """Open the page of a running server of the data folder; return False if no server responds."""
    import json
    from urllib.request import Request, urlopen

    from rocking_workbench.server import DataFolder

    running = DataFolder(settings.folder).running()
    if running is None:
        return False
    url, key = running
    head = {"Authorization": f"Bearer {key}", "Origin": url}
    try:
        with urlopen(Request(f"{url}/api/session/link", method="POST", headers=head), timeout=3) as answer:
            link = json.load(answer)["url"]
    except (OSError, ValueError, KeyError):
        return False
    print(f"{link}   (server is already running; link works once)", flush=True)
    if not quiet:
        _open(link)
    return True
