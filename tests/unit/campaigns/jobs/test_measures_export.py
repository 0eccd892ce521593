"""Intensity measures of a cloud campaign, ranked as the Python call ranks them, in every kind of file."""

import csv
import json
import math

import numpy as np
import pytest
from campaign_jobs import finished as through
from campaign_jobs import job
from scipy.io import loadmat

import rocking as rk
from rocking.campaigns import CampaignIncompleteError, CampaignInterrupted
from rocking.campaigns.jobs import Job, JobFolder, analyses, export, measure_comparison
from rocking.campaigns.jobs.exporting import exports_of, measures_table
from rocking.errors import InvalidValueError
from rocking.studies import SyntheticSet, compare_measures, fragility_analysis

pytestmark = pytest.mark.slow

COUNT, PGA = 40, 3.2
NAMES = ["pga", "pgv", "p pgv/(g tan alpha)", "arias", "sa(1.0)"]
HEAD = f"""[body]
units = "m"
width = 0.4
height = 2.0
[motions]
synthetic = "point-source"
count = {COUNT}
seed = 1
[fragility]
im = "pgv"
scale = 1.5
"""
EXPORT = f"[export]\nims = {json.dumps(NAMES)}\ncolumns = ['magnitude', 'ln distance_km']\n"


def text_of(*models, export_table=EXPORT, chunk=None):
    """Text of a cloud with some models."""
    restitution = f"[restitution]\nmodels = {json.dumps(models or ['ked'])}\n"
    return job("cloud", HEAD, restitution, export_table, chunk=chunk)


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    return through(tmp_path_factory.mktemp("cloud") / "c", text_of())


@pytest.fixture(scope="module")
def wanted():
    """Return the ranking of the Python call, on motions and metadata made anew."""
    motions = list(SyntheticSet("point-source", count=COUNT, seed=1))
    metadata = {
        "magnitude": [float(motion.metadata["magnitude"]) for motion in motions],
        "ln distance_km": [math.log(float(motion.metadata["distance_km"])) for motion in motions],
    }
    found = fragility_analysis(
        rk.Block(width=0.4, height=2.0), motions, restitution="ked", im="pgv", scale=1.5, analysis="cloud"
    )
    return compare_measures(found, NAMES, metadata)


def csv_rows(path):
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


def same(cell, value, within=0.0):
    """Return whether a cell holds a value, within a part of it: 0 is every bit; what is no number is left empty."""
    if isinstance(value, str):
        return cell == ("1" if value == "-" else value)
    number = math.nan if cell in {"", None} else float(cell)  # type: ignore[arg-type]
    if math.isnan(number):
        return not math.isfinite(float(value))  # type: ignore[arg-type]
    return math.isclose(number, float(value), rel_tol=within)  # type: ignore[arg-type]


def test_the_ranking_of_the_python_call(campaign, wanted):
    """All numbers of the ranking are those of `compare_measures`, bit for bit; fewer motions rank otherwise."""
    found = measure_comparison(campaign)
    assert found.rows() == wanted.rows()
    assert (dict(found.left_out), found.min_rotation) == (dict(wanted.left_out), wanted.min_rotation)
    assert len(found.scores) == len(NAMES)
    fewer = fragility_analysis(
        rk.Block(width=0.4, height=2.0),
        list(SyntheticSet("point-source", COUNT - 1, 1)),
        restitution="ked",
        scale=1.5,
        analysis="cloud",
    )
    assert compare_measures(fewer, NAMES).rows() != compare_measures(analyses(campaign)["ked"], NAMES).rows()


def test_csv_and_excel(campaign, wanted, tmp_path):
    """Both hold every row, by rank: CSV to the last bit, a workbook to the 16 digits that are written into it."""
    openpyxl = pytest.importorskip("openpyxl")
    export(campaign, tmp_path / "m.csv", "ims")
    export(campaign, tmp_path / "m.xlsx", "ims")
    book = openpyxl.load_workbook(tmp_path / "m.xlsx")
    head, *lines = book["rank"].iter_rows(values_only=True)
    of_csv, of_excel = csv_rows(tmp_path / "m.csv"), [dict(zip(head, line, strict=True)) for line in lines]
    for table, within in ((of_csv, 0.0), (of_excel, 1e-15)):
        for row, right in zip(table, wanted.rows(), strict=True):
            assert list(row) == list(right)
            assert all(same(row[name], value, within) for name, value in right.items())
    right = wanted.rows()[0]["efficiency"]
    assert not same(of_csv[0]["efficiency"], math.nextafter(right, 1.0))  # the control: one bit is seen
    beside = json.loads((tmp_path / "m.csv.provenance.json").read_text(encoding="utf-8"))
    assert beside["ims_left_out"] == {}
    assert beside["min_rotation_over_alpha"] == wanted.min_rotation
    assert "provenance" in [row[0] for row in book["provenance"].iter_rows(values_only=True)]


def test_netcdf_and_matlab(campaign, wanted, tmp_path):
    """Both hold the columns under names that the languages take, and the provenance."""
    xarray = pytest.importorskip("xarray")
    export(campaign, tmp_path / "m.nc", "ims")
    export(campaign, tmp_path / "m.mat", "ims")
    rows = wanted.rows()
    with xarray.open_dataset(tmp_path / "m.nc", engine="h5netcdf") as found:
        assert found["im"].values.tolist() == [row["im"] for row in rows]
        for name, variable in (("efficiency", "efficiency"), ("p(ln distance_km)", "p_ln_distance_km")):
            assert found[variable].values.tolist() == [row[name] for row in rows]
        assert json.loads(found.attrs["provenance"])["kind"] == "cloud"
    table = loadmat(tmp_path / "m.mat", simplify_cells=True)["table"]
    assert table["columns"]["efficiency"].tolist() == [row["efficiency"] for row in rows]
    assert table["columns"]["im"].tolist() == [row["im"] for row in rows]
    assert table["names"]["p_magnitude"] == "p(magnitude)"
    assert all(name.isidentifier() for name in table["columns"])


def test_resumed(campaign, tmp_path):
    """A campaign that was stopped and resumed exports the same bytes as the one that was not."""

    def stop(progress):
        if progress.chunks_done == 3:
            raise CampaignInterrupted("stopped on purpose")

    folder = JobFolder.create(tmp_path / "stopped", Job.of_text(text_of(chunk=7)))
    with pytest.raises(CampaignInterrupted):
        folder.run(progress=stop)
    with pytest.raises(CampaignIncompleteError, match=r"nothing to export because .* chunks"):
        export(folder, tmp_path / "early.csv", "ims")
    assert not (tmp_path / "early.csv").exists()
    resumed = JobFolder.open(tmp_path / "stopped")
    resumed.run()
    first, second = export(resumed, tmp_path / "a.csv", "ims"), export(campaign, tmp_path / "b.csv", "ims")
    assert first.read_bytes() == second.read_bytes()


def test_what_the_job_does_not_say(tmp_path):
    """Without [export] the usual measures and that of the job are ranked, against magnitude and ln distance."""
    text = text_of(export_table="").replace('"pgv"', '"sa(0.3)"')
    found = measure_comparison(through(tmp_path / "c", text))
    names = {score.im for score in found.scores}
    assert {"pga", "sa(0.3)", "cav", "housner"} <= names
    assert list(found.scores[0].sufficiency) == ["magnitude", "ln distance_km"]
    pulses = ", ".join(f'"half-sine:amplitude={a},period={t}"' for a in (3.0, 3.5, 4.0) for t in (0.2, 0.3, 0.4))
    body, _, rest = text.partition("[motions]")
    short = body + f"[motions]\npulse = [{pulses}]\n" + rest[rest.index("[fragility]") :]
    short = short.replace("scale = 1.5", "scale = 1.0").replace("height = 2.0", "height = 1.6")
    assert measure_comparison(through(tmp_path / "p", short)).scores[0].sufficiency == {}


def test_several_restitutions(tmp_path):
    """Each has a ranking of its own, which is that of a campaign with it alone; which one is meant must be said."""
    both = through(tmp_path / "both", text_of("housner", "ked"))
    assert exports_of(both) == [
        "histories", "fragility", "fragility-points", "fema-p58", "ims", "flips", "differences",
    ]  # fmt: skip
    with pytest.raises(InvalidValueError, match="restitution must be one of housner, ked"):
        export(both, tmp_path / "m.csv", "ims")
    alone = through(tmp_path / "alone", text_of("housner"))
    assert measure_comparison(both, "housner").rows() == measure_comparison(alone).rows()
    assert measure_comparison(both, "housner").rows() != measure_comparison(both, "ked").rows()
    export(both, tmp_path / "m.csv", "ims", restitution="housner")
    told = json.loads((tmp_path / "m.csv.provenance.json").read_text(encoding="utf-8"))
    assert told["restitution"] == "housner"


def test_progress(campaign, tmp_path):
    """What is told adds up to the histories of the campaign."""
    told: list[int] = []
    export(campaign, tmp_path / "m.csv", "ims", progress=told.append)
    assert sum(told) == COUNT
    assert len(told) == len(NAMES)


def test_nothing_to_export(finished, tmp_path):
    """Other kinds, and clouds in which nothing rocks, say why there is nothing."""
    for kind in ("overturning-map", "stripes", "incremental", "rocking-spectrum", "histories"):
        made = finished(kind)
        assert "ims" not in exports_of(made)
        with pytest.raises(InvalidValueError, match=f'nothing to export because .*"{kind}" has no ims, .* cloud'):
            export(made, tmp_path / "m.csv", "ims")
        with pytest.raises(InvalidValueError, match="only a cloud analysis compares measures"):
            measure_comparison(made)
    weak = text_of().replace("scale = 1.5", "scale = 0.01")
    made = finished("cloud", words=weak)
    with pytest.raises(InvalidValueError, match=r"nothing to export because .* Too few histories rocked"):
        export(made, tmp_path / "m.csv", "ims")
    assert list(tmp_path.glob("m.*")) == []


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("ims = ['pga', 'pgx']", "export: im must be one of"),
        ("ims = ['sa(1)', 'sa(1.0)']", r"export: sa\(1.0\) appears twice in ims"),
        ("ims = []", "export.ims"),
        (
            "columns = ['depth']",
            "export: 'depth' must be a number in the metadata of every motion, got no value for motion 0",
        ),
        ("columns = ['magnitude', 'magnitude']", "appears twice"),
        ("column = ['magnitude']", "unknown key 'column'; did you mean columns"),
    ],
)
def test_refusals_of_the_job(table, words):
    """A job that names what there is not is refused before anything is computed."""
    with pytest.raises(InvalidValueError, match=words):
        Job.of_text(text_of(export_table=f"[export]\n{table}\n"))


def test_only_of_clouds(text):
    """Other analyses take no list of measures."""
    with pytest.raises(InvalidValueError, match=r'export\.ims is allowed with kind = "cloud" only'):
        Job.of_text(text("stripes") + "[export]\nims = ['pga']\n")


def test_names_that_look_alike(wanted):
    """Columns whose names differ only in signs get variables of their own."""
    scores = [vars(score) | {"sufficiency": {"a b": 0.1, "a_b": 0.2, "a-b": 0.3}} for score in wanted.scores]
    alike = type(wanted)(tuple(type(wanted.scores[0])(**each) for each in scores), {})
    variables = [each.variable for each in measures_table(alike).columns.values()]
    assert len(set(variables)) == len(variables)
    assert {"p_a_b", "p_a_b_2", "p_a_b_3"} <= set(variables)
    assert np.isfinite(measures_table(alike).columns["p(a-b)"].values).all()


def test_command_line(tmp_path, answered, monkeypatch):
    """`rocking campaign export` takes the restitution of which it is: another has another ranking; JSON says what."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "job.toml").write_text(text_of("housner", "ked"), encoding="utf-8")
    answered("campaign", "run", "job.toml", "--output", "c")
    for name in ("housner", "ked"):
        told = answered("campaign", "export", "c", "--output", f"ims={name}.csv", "--restitution", name)
        assert told["what"] == "ims"
    assert (tmp_path / "housner.csv").read_bytes() != (tmp_path / "ked.csv").read_bytes()
