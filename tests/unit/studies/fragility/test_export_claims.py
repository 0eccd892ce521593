"""What keeps an exported curve honest: how it was found goes with it, and no worse state is likelier than a lesser."""

import math
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from scipy.io import loadmat

from rocking.errors import InvalidValueError
from rocking.statistics.lognormal import fit_lognormal
from rocking.statistics.ordered_probit import fit_ordered
from rocking.studies.fragility.curves import FragilityCurve, FragilityModel, curve_of, largest_excess
from rocking.studies.fragility.export import (
    fema_p58_table,
    moments_of_lognormal,
    table,
    to_csv,
    to_excel,
    to_mat,
    to_nrml,
)

TAG = "{http://openquake.org/xmlns/nrml/0.5}"
CROSSED = FragilityCurve("rotation > 0.5 alpha", 3.1, 0.2), FragilityCurve("overturned", 3.4, 0.8)


def model(**change):
    """Curves against PGA, without counts."""
    fields = {
        "name": "statue 1", "measure": "pga", "unit": "m/s2", "curves": CROSSED, "levels": [2.0, 4.0, 8.0],
        "trials": np.array([10, 10, 9]), "reached": {}, "source": "ten records", "uplift_threshold": 2.1,
        "about": {"software": "rocking"},
    }  # fmt: skip
    return FragilityModel(**(fields | change))


STEP = ([1.0, 2.0, 3.0, 4.0], [0, 0, 10, 10])


def separated():
    """A model whose one curve is the penalised convention for outcomes that form a step."""
    fit = fit_lognormal(*STEP, [10] * 4)
    assert fit.separation.step
    return model(
        curves=(curve_of("overturned", fit),), levels=STEP[0], trials=np.full(4, 10),
        reached={"overturned": np.array(STEP[1])},
    ), fit  # fmt: skip


def test_a_penalised_curve_says_so_in_every_file(tmp_path):
    """Method and verdict of a curve that is a convention reach FEMA P-58, NRML, netCDF, MATLAB and CSV."""
    made, fit = separated()
    told = "a convention, not a finding"
    assert told in fit.verdict
    rows = fema_p58_table(made)
    quality = rows.rows[0][rows.header.index("Data Quality and Relevance")]
    assert quality.startswith("Analytical; penalised; ")
    described = ET.parse(to_nrml(made, tmp_path / "f.xml")).getroot().find(f".//{TAG}description").text
    mat = loadmat(to_mat(made, tmp_path / "f.mat"), squeeze_me=True, struct_as_record=False)["fragility"]
    assert mat.method == "penalised"
    attributes = made.dataset.attrs
    assert attributes["method"] == "overturned: penalised"
    parameters = table(made)
    cells = dict(zip(parameters.header, parameters.rows[0], strict=True))
    for words in (quality, described, mat.verdict, attributes["verdict"], cells["verdict"]):
        assert told in words
    assert cells["intervals by"] == "profile"
    # nothing bounds the dispersion of a step but the penalty: ends are numbers or empty, never infinite
    assert all(cells[name] == "" or math.isfinite(cells[name]) for name in parameters.header if " 95 % " in name)


def crossed():
    """A model whose worse state is likelier at low levels, with counts of 60 histories each."""
    levels = np.array([1.0, 2.0, 3.0, 4.0, 6.0])
    reached = {"rotation > 0.5 alpha": np.array([6, 16, 35, 50, 60]), "overturned": np.array([4, 14, 22, 32, 45])}
    return model(curves=CROSSED, levels=levels, trials=np.full(5, 60), reached=reached)


def test_curves_that_cross_are_refused(tmp_path):
    """Where and by how much is named, from the densities' closed form; nothing is written; a hair's breadth is let."""
    # extreme where the densities are equal: a dense grid finds it as well
    grid = np.linspace(2.1, 60.0, 400_001)
    apart = CROSSED[1].probability(grid) - CROSSED[0].probability(grid)
    words = f"at {grid[apart.argmax()]:.4g} m/s2 'overturned' would be likelier.*by {apart.max():.2g}"
    for write in (lambda: to_nrml(crossed(), tmp_path / "f.xml"), lambda: fema_p58_table(crossed())):
        with pytest.raises(InvalidValueError, match=words):
            write()
    assert not list(tmp_path.iterdir())
    inside = largest_excess(crossed(), 0.0, 60.0)
    everywhere = np.linspace(1e-3, 60.0, 400_001)
    difference = CROSSED[1].probability(everywhere) - CROSSED[0].probability(everywhere)
    assert inside.size == pytest.approx(difference.max(), rel=1e-6)
    assert inside.level == pytest.approx(everywhere[difference.argmax()], rel=1e-3)
    assert largest_excess(crossed(), 3.3, 60.0) is None  # above the crossing the order is right
    assert largest_excess(model(curves=CROSSED[:1]), 0.0, 60.0) is None
    with pytest.raises(InvalidValueError, match="crossing must be one of"):
        to_nrml(crossed(), tmp_path / "f.xml", crossing="ignore")


def test_one_dispersion_for_all_states_on_request(tmp_path):
    """The files hold the curves of the ordered fit instead, which never cross, and say how they were found."""
    made = crossed()
    fit = fit_ordered(made.levels, *made.reached.values(), made.trials, method="common-dispersion")
    rows = fema_p58_table(made, crossing="common-dispersion")
    cells = [dict(zip(rows.header, row, strict=True)) for row in rows.rows]
    for cell, curve in zip(cells, (fit.rocked, fit.overturned), strict=True):
        assert (cell["Median Demand"], cell["Total Dispersion (Beta)"]) == curve
        assert "common-dispersion" in cell["Data Quality and Relevance"]
    path = to_nrml(made, tmp_path / "f.xml", crossing="common-dispersion")
    params = ET.parse(path).getroot().findall(f".//{TAG}params")
    mean = moments_of_lognormal(fit.overturned[0] / 9.80665, fit.overturned[1])[0]
    assert float(params[1].attrib["mean"]) == pytest.approx(mean, rel=1e-12)
    to_csv(made, tmp_path / "f.csv", "fema-p58", crossing="common-dispersion")
    with pytest.raises(InvalidValueError, match="counts of all states"):
        to_nrml(model(), tmp_path / "g.xml", crossing="common-dispersion")


def test_a_workbook_keeps_what_is_sound(tmp_path):
    """Curves that cross leave words on the sheet of FEMA P-58, and the other sheets whole."""
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.load_workbook(to_excel(crossed(), tmp_path / "f.xlsx"))
    assert "must not cross" in book["fema-p58"]["A1"].value
    assert book["parameters"]["D2"].value == 3.1
    whole = openpyxl.load_workbook(to_excel(crossed(), tmp_path / "g.xlsx", crossing="common-dispersion"))
    assert whole["fema-p58"].max_row == 3
