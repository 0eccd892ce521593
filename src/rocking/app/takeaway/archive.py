"""An archive that somebody sent: a few files beside each other, unpacked in memory within limits, never to a disk."""

import io
import zlib
from zipfile import ZIP_DEFLATED, ZIP_STORED, BadZipFile, ZipFile, ZipInfo

from rocking.app.errors import Refused, TooLarge
from rocking.app.takeaway.plain_text import plain_line

MOST_FILES = 8
"""Files of an archive; ours have three at most."""

_BEGINNINGS = (b"PK\x03\x04", b"PK\x05\x06")
_ENTRY = b"PK\x01\x02"
_MOST_ENTRIES = 64  # a packed record may hold the four bytes by chance
_ENCRYPTED = 0x1


class Archive:
    """The files of a ZIP archive, by their names."""

    def __init__(self, data: bytes) -> None:
        if data.count(_ENTRY) > _MOST_ENTRIES:  # before all of them are read
            raise TooLarge(f"an archive may hold up to {MOST_FILES} files")
        try:
            self._archive = ZipFile(io.BytesIO(data))
        except (BadZipFile, ValueError, NotImplementedError, OSError) as error:
            raise Refused("this is no ZIP archive that can be read: is it damaged?") from error
        entries = self._archive.infolist()
        if len(entries) > MOST_FILES:
            raise TooLarge(f"an archive may hold up to {MOST_FILES} files, this has {len(entries)}")
        for entry in entries:
            _check_entry(entry)
        self._entries = {entry.filename: entry for entry in entries}
        if len(self._entries) < len(entries):
            raise Refused("the archive holds two files of one name")

    @staticmethod
    def begins(data: bytes) -> bool:
        """Return whether bytes begin as a ZIP archive does."""
        return data.startswith(_BEGINNINGS)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the files."""
        return tuple(self._entries)

    def content(self, name: str, most: int) -> bytes:
        """Return a file, unpacked.

        most: largest size [bytes].
        """
        try:
            with self._archive.open(self._entries[name]) as file:
                found = file.read(most + 1)
        except (BadZipFile, zlib.error, EOFError, ValueError, NotImplementedError, RuntimeError, OSError) as error:
            raise Refused(f"{plain_line(name, 60)} in the archive is damaged") from error
        if len(found) > most:
            raise TooLarge(f"{plain_line(name, 60)} in the archive has more than {most} bytes")
        return found


def _check_entry(entry: ZipInfo) -> None:
    name = plain_line(entry.filename, 60)
    # orig_filename is what stands in the archive: a NUL cuts the other one off
    if (
        entry.orig_filename != entry.filename
        or set(entry.filename) & set("/\\:\0")
        or entry.filename in {"", ".", ".."}
    ):
        raise Refused(f"the archive holds {name!r}: files must lie beside each other, without folders")
    if entry.flag_bits & _ENCRYPTED:
        raise Refused(f"{name} in the archive is encrypted")
    if entry.compress_type not in {ZIP_STORED, ZIP_DEFLATED}:
        raise Refused(f"{name} in the archive is packed in a way that is not read here: pack it as usual (deflate)")
