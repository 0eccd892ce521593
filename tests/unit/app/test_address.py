"""Where the server listens, and whose the data folder is."""

import json
import stat
import sys
from pathlib import Path

import pytest

from rocking.app.folder import DataFolder, FolderInUseError, write_private
from rocking.app.server import check_host, listen
from rocking.app.settings import ServerSettings, default_folder
from rocking.errors import InvalidValueError


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "::1"])
def test_loopback_needs_no_word(host: str) -> None:
    """Loopback is allowed as it is."""
    check_host(host, allow_remote=False)


def test_other_addresses_need_the_flag() -> None:
    """An address that others reach is refused without the flag, and every address at once always."""
    check_host("192.0.2.7", allow_remote=True)
    with pytest.raises(InvalidValueError, match="--allow-remote"):
        check_host("192.0.2.7", allow_remote=False)
    for everywhere in ("0.0.0.0", "::", ""):
        with pytest.raises(InvalidValueError, match="every address"):
            check_host(everywhere, allow_remote=True)


def test_taken_port_gives_the_next_only_if_none_was_asked_for() -> None:
    """A taken port: the next one where any serves, a sentence where that one was asked for."""
    with listen("127.0.0.1", 0, search=False) as first:
        taken = first.getsockname()[1]
        with pytest.raises(InvalidValueError, match=f"port {taken} is taken"):
            listen("127.0.0.1", taken, search=False)
        with listen("127.0.0.1", taken, search=True) as second:
            assert taken < second.getsockname()[1] < taken + 50


@pytest.mark.parametrize(
    ("host", "port"), [("127.0.0.1", 70_000), ("127.0.0.1", -1), ("192.0.2.7", 0), ("no.invalid", 0)]
)
def test_impossible_addresses_are_told(host: str, port: int) -> None:
    """A port out of range and an address that is not of this machine are refused in words."""
    with pytest.raises(InvalidValueError):
        listen(host, port, search=False)


def test_folder_is_private_and_of_one_server(tmp_path: Path) -> None:
    """The data folder and the key are for their owner only, of one server at a time, and the key goes with it."""
    path = tmp_path / "deep" / "data"
    with DataFolder(path) as folder:
        key_file = folder.publish("http://127.0.0.1:1", "key")
        if sys.platform != "win32":
            assert stat.S_IMODE(path.stat().st_mode) == 0o700
            assert stat.S_IMODE(key_file.stat().st_mode) == 0o600
        assert key_file.read_text() == "key"
        assert DataFolder(path).running() == ("http://127.0.0.1:1", "key")
        with pytest.raises(FolderInUseError, match="another rocking serve"), DataFolder(path):
            pass
        assert key_file.exists()
    assert not key_file.exists()
    assert DataFolder(path).running() is None
    with DataFolder(path):
        pass


def test_key_is_never_written_through_a_link(tmp_path: Path) -> None:
    """A link that lies where the key goes is replaced, and what it points to stays as it is."""
    victim = tmp_path / "victim"
    victim.write_text("mine")
    link = tmp_path / "api-key"
    link.symlink_to(victim)
    write_private(link, "key")
    assert victim.read_text() == "mine"
    assert link.read_text() == "key"
    assert not link.is_symlink()


def test_folder_that_cannot_be_made_is_told(tmp_path: Path) -> None:
    """A file in the way of the data folder is told in words."""
    (tmp_path / "file").write_text("")
    with pytest.raises(InvalidValueError, match="--data"), DataFolder(tmp_path / "file" / "data"):
        pass


def test_note_of_another_machine_is_not_followed(tmp_path: Path) -> None:
    """On a shared disk a server of another machine is not asked on this one."""
    (tmp_path / "server.json").write_text(json.dumps({"url": "http://127.0.0.1:1", "machine": "elsewhere"}))
    (tmp_path / "api-key").write_text("key")
    assert DataFolder(tmp_path).running() is None


def test_default_folder_follows_the_system(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """The data folder is where the system keeps data of programs."""
    if sys.platform != "win32":
        monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
        assert default_folder() == tmp_path / "rocking"
        monkeypatch.delenv("XDG_DATA_HOME")
        assert default_folder() == Path.home() / ".local" / "share" / "rocking"


def test_origin_of_the_page() -> None:
    """The address of the page, with brackets where the address has colons."""
    assert ServerSettings().origin == "http://127.0.0.1:8765"
    assert ServerSettings(host="::1", port=9).origin == "http://[::1]:9"
