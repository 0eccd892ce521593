"""Photos of an inventory: thumbnails beside the objects, and which of them cannot be shown."""

import warnings
from pathlib import Path

from rocking.errors import extra
from rocking.studies.inventory.assessment import Assessment

MOST_BYTES, MOST_PIXELS = 64 << 20, 100_000_000
"""No photo is larger: it is left aside before it is decoded."""

SIDE = 240  # of a thumbnail, at most [pixels]
_FORMATS = ("JPEG", "PNG", "WEBP", "TIFF", "GIF", "BMP")


def thumbnails(assessment: Assessment, folder: Path) -> dict[int, str]:
    """Write small pictures; return their names by the place of the object, empty where none could be made."""
    found = {}
    for place, verdict in enumerate(assessment.verdicts):
        if verdict.item.photo is not None:
            name = f"photo-{place}.jpg"
            found[place] = name if _thumbnail(verdict.item.photo, folder / name) else ""
    return found


def _thumbnail(photo: Path, path: Path) -> bool:
    """Return whether a small picture could be made of a file, whatever that is."""
    try:
        image, ops = extra("PIL.Image", "thumbnails"), extra("PIL.ImageOps", "thumbnails")
        if not photo.is_file() or photo.stat().st_size > MOST_BYTES:
            return False
        with warnings.catch_warnings(action="ignore"), image.open(photo, formats=_FORMATS) as opened:
            if opened.width * opened.height > MOST_PIXELS:
                return False
            opened.draft("RGB", (2 * SIDE, 2 * SIDE))
            small = ops.exif_transpose(opened).convert("RGB")
            small.thumbnail((SIDE, SIDE))
            small.save(path, "JPEG", quality=80)
    except Exception:  # noqa: BLE001 - decoders of damaged pictures raise anything, and no photo may fail a report
        return False
    return True
