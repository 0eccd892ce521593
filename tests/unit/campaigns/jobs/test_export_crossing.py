"""Curves that cross, in files of campaigns: refused, or one dispersion for all states, as the Python export has it."""

import pytest

from rocking.campaigns.jobs import Job, JobFolder, analyses, export
from rocking.errors import InvalidValueError
from rocking.studies.fragility.curves import model_of
from rocking.studies.fragility.export import to_csv, to_nrml

NAME = "a small stripes"
TOLD = '[export]\ncrossing = "common-dispersion"\n'


@pytest.fixture
def crossed(finished, text):
    """Campaign of stripes whose states have unlike dispersions, and cross within the levels."""
    words = text("stripes").replace("count = 5", "count = 9")
    return lambda more="": finished("stripes", 64 + len(more), words + more)


@pytest.mark.parametrize(("what", "name", "write"), [("fragility", "r.xml", to_nrml), ("fema-p58", "r.csv", None)])
def test_common_dispersion(crossed, tmp_path, what, name, write):
    """Refused as it stands; with the option, the bytes of the Python export with the same option."""
    folder = crossed()
    with pytest.raises(InvalidValueError, match="curves must not cross"):
        export(folder, tmp_path / name, what)
    assert not list(tmp_path.glob("r.*"))
    found = export(folder, tmp_path / name, what, crossing="common-dispersion")
    model = model_of(next(iter(analyses(folder).values())), NAME)
    if write is None:
        wanted = to_csv(model, tmp_path / "w.csv", "fema-p58", crossing="common-dispersion")
    else:
        wanted = to_nrml(model, tmp_path / "w.xml", crossing="common-dispersion")
    assert found.read_bytes() == wanted.read_bytes()


def test_the_job_may_say_it(crossed, tmp_path):
    """[export] in the job is what counts unless the call says otherwise."""
    folder = crossed(TOLD)
    path = export(folder, tmp_path / "r.xml", "fragility")
    assert (
        path.read_bytes()
        == export(crossed(), tmp_path / "s.xml", "fragility", crossing="common-dispersion").read_bytes()
    )
    with pytest.raises(InvalidValueError, match="curves must not cross"):
        export(folder, tmp_path / "t.xml", "fragility", crossing="refuse")


def test_refusals(crossed, text, tmp_path):
    """It is about curves only, and there are two ways."""
    folder = crossed()
    with pytest.raises(InvalidValueError, match="crossing must be one of refuse, common-dispersion, got 'maybe'"):
        export(folder, tmp_path / "r.xml", "fragility", crossing="maybe")
    with pytest.raises(InvalidValueError, match="it is about curves"):
        export(folder, tmp_path / "r.nc", crossing="refuse")
    with pytest.raises(InvalidValueError, match=r"export\.crossing"):
        Job.of_text(text("stripes") + TOLD.replace("common-", "un"))
    with pytest.raises(InvalidValueError, match=r"\[export\] goes with stripes, incremental, cloud"):
        JobFolder.create(tmp_path / "m", Job.of_text(text("overturning-map") + TOLD))
