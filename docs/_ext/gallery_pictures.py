"""The gallery: its order, from simple to advanced, and the pictures of its scripts.

A picture belongs to the block of code that names it, as in ``write(figure, "overturning_map.png")``: there the page and
the notebook show it.
"""

import re
import shutil
import warnings
from pathlib import Path
from typing import Any

from PIL import Image, ImageChops, ImageOps
from sphinx.application import Sphinx
from sphinx_gallery import gen_rst

from rocking.errors import PlausibilityWarning

SECTIONS = {
    "impacts": [
        "coefficient_of_a_block",
        "asymmetric_statue",
        "prediction_with_interval",
        "energy_of_the_three_stages",
        "own_model",
        "league_with_own_model",
        "impact_laboratory",
        "coefficient_from_a_sound",
    ],
    "motions": [
        "pulses_of_every_kind",
        "record_from_a_file",
        "processing_a_motion",
        "synthetic_motions",
        "synthetic_record_sets",
    ],
    "responses": [
        "one_cabinet_three_models",
        "response_to_a_pulse",
        "free_rocking_decay",
        "results_that_reopen",
        "many_histories",
        "laws_of_impact",
        "beyond_the_slenderness_angle",
        "is_pure_rocking_credible",
    ],
    "maps": [
        "overturning_map_of_a_pulse",
        "minimum_overturning_acceleration",
        "map_of_size_and_slenderness",
        "rocking_spectrum_of_motions",
        "crossings_under_many_motions",
        "refined_map_with_boundary",
    ],
    "fragility": [
        "inventory_of_objects",
        "fragility_by_stripes",
        "does_the_restitution_model_matter",
        "incremental_analysis_with_resurrection",
        "which_intensity_measure",
        "how_likely_it_overturns",
        "were_the_predictions_right",
    ],
    "space": [
        "solid_statue",
        "solid_from_a_file",
        "ways_a_body_can_stand",
        "falling_by_direction",
        "round_base_by_corners",
    ],
    "campaigns": ["campaign_that_resumes", "campaign_of_a_cloud"],
}
"""Sections in their order, and the scripts of each in theirs."""

NAMED = re.compile(r'"(\w+\.(?:png|gif))"')
"""How a script names a picture that it writes."""

PARTS = {
    "prediction_with_interval": (1, 0, (0.0, 0.0, 0.68, 1.0)),
    "league_with_own_model": (1, 0, (0.28, 0.0, 1.0, 1.0)),
    "impact_laboratory": (1, 0, (0.0, 0.0, 0.37, 1.0)),
    "record_from_a_file": (1, 0, (0.0, 0.08, 0.62, 1.0)),
    "processing_a_motion": (1, 0, (0.6, 0.08, 1.0, 1.0)),
    "synthetic_record_sets": (1, 0, (0.5, 0.0, 1.0, 0.88)),
    "one_cabinet_three_models": (1, 66, (0.0, 0.08, 1.0, 0.52)),
    "response_to_a_pulse": (1, 0, (0.0, 0.26, 1.0, 0.49)),
    "free_rocking_decay": (1, 0, (0.0, 0.26, 1.0, 0.49)),
    "beyond_the_slenderness_angle": (2, 48, (0.0, 0.08, 1.0, 0.56)),
    "fragility_by_stripes": (1, 0, (0.0, 0.0, 1.0, 0.66)),
    "inventory_of_objects": (1, 0, (0.0, 0.05, 0.62, 0.92)),
    "does_the_restitution_model_matter": (1, 0, (0.34, 0.0, 0.9, 0.84)),
    "refined_map_with_boundary": (1, 0, (0.5, 0.1, 1.0, 0.86)),
    "solid_statue": (1, 0, (0.0, 0.0, 0.7, 1.0)),
    "round_base_by_corners": (1, 0, (0.0, 0.0, 0.36, 1.0)),
    "ways_a_body_can_stand": (1, 0, (0.0, 0.0, 0.36, 0.86)),
    "falling_by_direction": (1, 0, (0.0, 0.06, 0.36, 0.86)),
    "which_intensity_measure": (1, 0, (0.0, 0.1, 0.6, 1.0)),
}
"""Source of a thumbnail other than the first picture: picture, frame, segment (left, top, right, bottom)."""

_INCH, _WIDEST, _THUMBNAIL, _MARGIN = 120, 900, (456, 312), 12
"""Dots of a page in an inch of a picture, width of its text [px]; thumbnails and their margin at twice their size."""


def section_order(folder: str) -> int:
    """Return the place of a section."""
    return list(SECTIONS).index(Path(folder).name)


def script_order(name: str) -> int:
    """Return the place of a script in its section."""
    stem = Path(name).stem
    return next(scripts.index(stem) for scripts in SECTIONS.values() if stem in scripts)


def scraper(block: Any, variables: dict[str, Any], conf: dict[str, Any]) -> str:
    """Show the pictures that a block of code names, which it has written into the folder where it ran."""
    shown = []
    for name in dict.fromkeys(NAMED.findall(block.content)):
        written = Path(variables["src_file"]).with_name(name)
        target = Path(next(variables["image_path_iterator"])).with_suffix(written.suffix)
        width = _light(written, target) if written.suffix == ".png" else _copied(written, target)
        path = "/" + target.relative_to(conf["src_dir"]).as_posix()
        alt = written.stem.replace("_", " ")
        shown.append(f"\n.. image:: {path}\n   :alt: {alt}\n   :width: {width}px\n   :class: gallery-picture\n")
    return "\n".join(shown)


def _light(written: Path, target: Path) -> int:
    """Copy a picture in the dots and colours that a page needs, and return its width on the page [px]."""
    with Image.open(written) as picture:
        width = min(round(picture.width / picture.info["dpi"][0] * _INCH), _WIDEST)
        picture.thumbnail((2 * width, 20 * width))
        picture.convert("RGB").quantize(256, dither=Image.Dither.NONE).save(target, optimize=True)
    return width


def _copied(written: Path, target: Path) -> int:
    """Copy a film, and return its width [px]."""
    shutil.copyfile(written, target)
    with Image.open(target) as film:
        return film.width


def thumbnails(app: Sphinx) -> None:
    """Write the thumbnails: a recognisable segment of the picture, without its margin, on white."""
    for section, scripts in SECTIONS.items():
        folder = Path(app.srcdir) / "gallery" / section / "images"
        for script in scripts:
            number, frame, crop = PARTS.get(script, (1, 0, (0.0, 0.0, 1.0, 1.0)))
            (source,) = folder.glob(f"sphx_glr_{script}_{number:03}.*")
            (thumbnail,) = (folder / "thumb").glob(f"sphx_glr_{script}_thumb.*")
            with Image.open(source) as picture:
                picture.seek(frame)
                shown = picture.convert("RGB")
            box = [round(edge * size) for edge, size in zip(crop, 2 * shown.size, strict=True)]
            shown = shown.crop(box)
            shown = shown.crop(ImageChops.difference(shown, Image.new("RGB", shown.size, "white")).getbbox())
            inner = ImageOps.pad(shown, _THUMBNAIL, Image.Resampling.LANCZOS, "white")
            ImageOps.expand(inner, _MARGIN, "white").save(thumbnail)


def notebook(blocks: Any, conf: dict[str, Any], folder: Any) -> dict[str, Any]:
    """Return the notebook of a script, in which a cell that writes pictures shows them."""
    document: dict[str, Any] = _plain_notebook(blocks, conf, folder)
    for cell in document["cells"]:
        names = dict.fromkeys(NAMED.findall("".join(cell["source"]))) if cell["cell_type"] == "code" else ()
        if names:
            shown = ", ".join(f'Image("{name}")' for name in names)
            cell["source"] = [*cell["source"], f"\n\nfrom IPython.display import Image\n\ndisplay({shown})"]
    return document


_plain_notebook = gen_rst.jupyter_notebook


def setup(app: Sphinx) -> dict[str, bool]:
    """Let notebooks show pictures, and scripts run in a copy of their folder, into which they write."""
    gen_rst.jupyter_notebook = notebook
    warnings.simplefilter("error", PlausibilityWarning)  # examples contain no implausible values
    app.connect("builder-inited", thumbnails, priority=900)
    here = Path(app.srcdir)
    shutil.rmtree(copy := here.parent / "build" / "examples", ignore_errors=True)
    shutil.copytree(here.parent / "examples", copy, ignore=shutil.ignore_patterns("__pycache__"))
    return {"parallel_read_safe": True}
