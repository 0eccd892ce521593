"""The gallery: its order, from easy to deep, and the pictures that its scripts write.

A picture belongs to the block of code that names it, as in ``write(figure, "overturning_map.png")``: there the page and
the notebook show it.
"""

import re
import shutil
from pathlib import Path
from typing import Any

from PIL import Image
from sphinx.application import Sphinx
from sphinx_gallery import gen_rst
from sphinx_gallery.scrapers import figure_rst

SECTIONS = {
    "impacts": [
        "coefficient_of_a_block",
        "asymmetric_statue",
        "prediction_with_interval",
        "energy_of_the_three_stages",
        "own_model",
        "league_with_own_model",
        "impact_laboratory",
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
    ],
    "space": ["solid_statue", "solid_from_a_file", "falling_by_direction", "round_base_by_corners"],
    "campaigns": ["campaign_that_resumes", "campaign_of_a_cloud"],
}
"""Sections in their order, and the scripts of each in theirs."""

NAMED = re.compile(r'"(\w+\.(?:png|gif))"')
"""How a script names a picture that it writes."""

_WIDEST = 1500
"""Dots across a picture of a page: twice the width of its text."""


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
        if written.suffix == ".png":
            _light(written, target)
        else:
            shutil.copyfile(written, target)
        shown.append(target)
    return "".join(figure_rst([each], conf["src_dir"]) for each in shown)


def _light(written: Path, target: Path) -> None:
    """Copy a picture as wide as a page shows it, in 256 colours."""
    with Image.open(written) as picture:
        picture.thumbnail((_WIDEST, 10 * _WIDEST))
        picture.convert("RGB").quantize(256, dither=Image.Dither.NONE).save(target, optimize=True)


def notebook(blocks: Any, conf: dict[str, Any], folder: Any) -> dict[str, Any]:
    """Return the notebook of a script, in which a cell that writes pictures shows them."""
    made: dict[str, Any] = _plain_notebook(blocks, conf, folder)
    for cell in made["cells"]:
        names = dict.fromkeys(NAMED.findall("".join(cell["source"]))) if cell["cell_type"] == "code" else ()
        if names:
            shown = ", ".join(f'Image("{name}")' for name in names)
            cell["source"] = [*cell["source"], f"\n\nfrom IPython.display import Image\n\ndisplay({shown})"]
    return made


_plain_notebook = gen_rst.jupyter_notebook


def setup(app: Sphinx) -> dict[str, bool]:
    """Let notebooks show pictures, and scripts run in a copy of their folder, into which they write."""
    gen_rst.jupyter_notebook = notebook
    here = Path(app.srcdir)
    shutil.rmtree(copy := here.parent / "build" / "examples", ignore_errors=True)
    shutil.copytree(here.parent / "examples", copy, ignore=shutil.ignore_patterns("__pycache__"))
    return {"parallel_read_safe": True}
