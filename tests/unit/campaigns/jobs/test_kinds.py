"""Every kind of job: the same bits as the Python call that a user would have made."""

import numpy as np
import pytest
from campaign_jobs import finished as all_rounds

import rocking as rk
from rocking import examples
from rocking.campaigns.jobs import Job, analyses, export
from rocking.errors import InvalidValueError
from rocking.motions.filters import geometric
from rocking.spec.questions import questions
from rocking.studies import SyntheticSet, overturning_map, rocking_spectrum
from rocking.studies.fragility import fragility_analysis
from rocking.studies.sensitivity import SampledRestitution

pytestmark = pytest.mark.slow

xr = pytest.importorskip("xarray")
pytest.importorskip("h5netcdf")

BLOCK = rk.Block(width=0.5, height=2.0)
PULSES = [rk.pulses.sine(1.0, 0.5), rk.pulses.sine(1.0, 0.7), rk.pulses.ricker(1.0, 0.9)]


def opened(folder, tmp_path):
    """What xarray finds in the exported file."""
    return xr.load_dataset(export(folder, tmp_path / "result.nc"), engine="h5netcdf")


def same(found, wanted, names):
    """Whether variables have the same bits, whatever the order of the dimensions."""
    for name in names:
        left = found[name].transpose(*wanted[name].dims).values
        right = wanted[name].values.astype(left.dtype)
        assert np.array_equal(left, right, equal_nan=left.dtype.kind == "f"), name
    assert (found["outcome"] == 2).any()
    assert (found["outcome"] != 2).any()


def plain(attributes):
    """Attributes as they are read again: flags are arrays in a file."""
    return {name: np.asarray(value).tolist() for name, value in attributes.items()}


def sines():
    """The map of one call."""
    axes = ("frequency_ratio", np.linspace(1, 7, 9)), ("amplitude_ratio", np.linspace(1, 9, 7))
    return overturning_map(BLOCK, rk.pulses.sine(3.0, 0.6), *axes)


def spectra():
    """The spectra of one call."""
    pulses = [rk.pulses.sine(4.0, 0.5), rk.pulses.sine(4.0, 0.7), rk.pulses.ricker(4.0, 0.9)]
    return rocking_spectrum(pulses, [0.15, 0.3], geometric(1.5, 9, 6))


def many():
    """Every combination of one call."""
    bodies = [BLOCK, rk.Block(width=0.3, height=1.0)]
    return rk.simulate_many(bodies, PULSES, ["housner", "ked"], scale=[2.5, 5.0, 8.0, 11.0])


@pytest.mark.parametrize(
    ("kind", "chunk", "call"),
    [
        ("overturning-map", None, sines), ("overturning-map", 10, sines),
        ("rocking-spectrum", 7, spectra), ("histories", 11, many),
    ],
)  # fmt: skip
def test_file_is_the_dataset_of_the_call(finished, tmp_path, kind, chunk, call):
    """In chunks that cut through rows: every bit of the call's variables and coordinates, and every attribute."""
    wanted, found = call(), opened(finished(kind, chunk), tmp_path)
    same(found, wanted, [*wanted.data_vars])
    for name in wanted.coords:
        assert found[name].values.tolist() == wanted[name].values.tolist(), name
        assert found[name].attrs.get("units") == wanted[name].attrs.get("units", found[name].attrs.get("units"))
    if kind == "overturning-map":
        assert set(found.variables) == set(wanted.variables)
        assert all(plain(found[name].attrs) == plain(wanted[name].attrs) for name in wanted.variables)
    # how much work it was a campaign does not say
    attributes = {name: value for name, value in wanted.attrs.items() if not name.startswith("work_")}
    assert {name: found.attrs[name] for name in attributes} == attributes
    assert "contact" in attributes


def test_map_with_friction(finished, tmp_path, text):
    """Bodies that slide, hop and fly: every bit and attribute of the call."""
    words = text("overturning-map", 13) + "[settings]\nfriction = 0.3\nbounce = 0.1\n"
    found = opened(finished("overturning-map", 13, words), tmp_path)
    axes = ("frequency_ratio", np.linspace(1, 7, 9)), ("amplitude_ratio", np.linspace(1, 9, 7))
    wanted = overturning_map(BLOCK, rk.pulses.sine(3.0, 0.6), *axes, friction=0.3, normal_restitution=0.1)
    same(found, wanted, [*wanted.data_vars])
    attributes = {name: value for name, value in wanted.attrs.items() if not name.startswith("work_")}
    assert {name: found.attrs[name] for name in attributes} == attributes
    assert not (wanted["mode"] == sines()["mode"]).all()


def test_map_over_friction(finished, tmp_path, text):
    """Friction as an axis, refined or not: every bit of the call."""
    head = text("overturning-map", 13).partition("[map]")[0]
    axes = (
        '[map]\nx = { axis = "friction", values = [0.1, 0.2, 0.3, 0.6] }\n'
        'y = { axis = "scale", from = 1.0, to = 4.0, count = 6 }\n'
    )
    values = ("friction", [0.1, 0.2, 0.3, 0.6]), ("scale", np.linspace(1.0, 4.0, 6))
    wanted = overturning_map(BLOCK, rk.pulses.sine(3.0, 0.6), *values)
    found = opened(finished("overturning-map", 13, head + axes), tmp_path)
    same(found, wanted, [*wanted.data_vars])
    assert len({tuple(row) for row in wanted["mode"].values.T.tolist()}) > 1, "the friction matters"
    refined = all_rounds(tmp_path / "fine", head + axes.replace("[map]\n", "[map]\nrefine = 1\n"))
    fine = overturning_map(BLOCK, rk.pulses.sine(3.0, 0.6), *values, refine=1)
    assert opened(refined, tmp_path).sizes["point"] == fine.sizes["point"]


def test_map_of_bodies_and_restitutions(finished, tmp_path, text):
    """Axes that change the body, with two models: each is the map of its own call."""
    words = text("overturning-map", 13).replace("frequency_ratio", "semi_diagonal").replace("amplitude_ratio", "scale")
    found = opened(finished("overturning-map", 13, words + '[restitution]\nmodels = ["housner", "ked"]\n'), tmp_path)
    assert list(found["outcome"].dims) == ["restitution", "scale", "semi_diagonal"]
    for label in ("housner", "ked"):
        wanted = overturning_map(
            BLOCK, rk.pulses.sine(3.0, 0.6),
            ("semi_diagonal", np.linspace(1, 7, 9)), ("scale", np.linspace(1, 9, 7)), label,
        )  # fmt: skip
        same(found.sel(restitution=label), wanted, [*wanted.data_vars])


@pytest.mark.parametrize("chunk", [2, 100])
def test_map_with_cells_that_are_no_body(finished, tmp_path, text, chunk):
    """Cells of blocks wider than their diagonal fail alone, chunks of nothing else included; others keep every bit."""
    head, _, _ = text("overturning-map", chunk).partition("[map]")
    axes = (
        "[map]\nx = { axis = 'width', values = [0.3, 0.5, 5.0, 6.0] }\ny = { axis = 'semi_diagonal', values = [1, 2] }"
    )
    wanted = overturning_map(
        BLOCK, rk.pulses.sine(5.0, 0.6), ("width", [0.3, 0.5, 5.0, 6.0]), ("semi_diagonal", [1.0, 2.0])
    )
    found = opened(finished("overturning-map", chunk, head.replace("amplitude=3", "amplitude=5") + axes), tmp_path)
    assert found["mode"].values[:, 2:].tolist() == [[-3, -3], [-3, -3]]
    assert (found["mode"].values[:, :2] > -3).all()
    same(found, wanted, [*wanted.data_vars])


def test_spectrum_with_a_law_has_no_coefficient(finished, tmp_path, text):
    """As in `rocking_spectrum`, the coefficient is missing where a law changes it from impact to impact."""
    law = "[restitution.distribution]\nmean = 0.9\ndeviation = 0.05\nseed = 8\n"
    found = opened(finished("rocking-spectrum", 7, text("rocking-spectrum", 7) + law), tmp_path)
    assert np.isnan(found["coefficient"]).all()
    assert found["coefficient"].shape == (2, 6)


def test_stripes_are_multiple_stripes(finished, tmp_path):
    """Stripes of synthetic motions: outcomes, counts, curves and summary of the one call."""
    motions = SyntheticSet("pulse-like", 12, 4)
    wanted = fragility_analysis(BLOCK, motions, np.linspace(2, 10, 5), limit_states=(0.3,))
    folder = finished("stripes", 9)
    found = analyses(folder)["calibrated"]
    assert np.array_equal(found.responses.rotation, wanted.responses.rotation, equal_nan=True)
    assert found.summary() == wanted.summary()
    file = opened(folder, tmp_path)
    assert np.array_equal(file["outcome"], wanted.responses.outcome)
    assert np.array_equal(file["scale"], wanted.histories.scales)
    assert file["level"].attrs["units"] == "m/s2"


def test_incremental_is_incremental(finished):
    """Incremental: the same intervals to the last bit, searched after the campaign."""
    wanted = fragility_analysis(BLOCK, PULSES, [2.0, 4.0, 6.0, 9.0], 0.9, limit_states=(), analysis="incremental")
    found = analyses(finished("incremental", 5))["0.9"]
    assert found.intervals == wanted.intervals
    assert len(found.intervals) >= 3
    assert found.summary() == wanted.summary()


def test_cloud_is_cloud(finished, tmp_path):
    """Cloud: the same outcomes and summary, and the intensities of the scaled motions beside them."""
    wanted = fragility_analysis(BLOCK, SyntheticSet("pulse-like", 12, 4), im="pgv", scale=2.0, analysis="cloud")
    folder = finished("cloud", 5)
    assert analyses(folder)["calibrated"].summary() == wanted.summary()
    file = opened(folder, tmp_path)
    assert file["outcome"].dims == ("motion",)
    assert np.array_equal(np.sort(file["intensity"]), wanted.levels)


def test_fragility_of_several_restitutions(finished, text):
    """Stripes with two models are two analyses, each as if it were alone."""
    folder = finished("stripes", 9, text("stripes", 9) + '[restitution]\nmodels = ["ked", "housner"]\n')
    found = analyses(folder)
    for label in ("ked", "housner"):
        wanted = fragility_analysis(
            BLOCK, SyntheticSet("pulse-like", 12, 4), np.linspace(2, 10, 5), label, limit_states=(0.3,)
        )
        assert np.array_equal(found[label].responses.rotation, wanted.responses.rotation, equal_nan=True)
    assert not np.array_equal(found["ked"].responses.rotation, found["housner"].responses.rotation)


@pytest.mark.parametrize("each", ["impact", "history"])
def test_drawn_restitution(finished, text, each):
    """Coefficients drawn per impact or per history depend on the number of the history, not on the chunk."""
    drawn = f'[restitution.distribution]\nmean = 0.9\ndeviation = 0.05\neach = "{each}"\nseed = 8\n'
    folders = [finished("cloud", chunk, text("cloud", chunk) + drawn) for chunk in (5, 12)]
    one, other = (folder.campaign.results() for folder in folders)
    assert np.array_equal(one["peak_rotation"], other["peak_rotation"])
    law = (rk.dynamics.RandomRestitution if each == "impact" else SampledRestitution).normal(0.9, 0.05, seed=8)
    (found,) = analyses(folders[0]).values()
    motions = SyntheticSet("pulse-like", 12, 4)
    if each == "impact":
        wanted = fragility_analysis(BLOCK, motions, restitution=law, im="pgv", scale=2.0, analysis="cloud")
        assert np.array_equal(found.responses.rotation, wanted.responses.rotation)
    assert not np.array_equal(found.responses.rotation, analyses(finished("cloud", 7))["calibrated"].responses.rotation)


def test_kinds_without_fragility(finished):
    """A map has no fragility, and says so."""
    with pytest.raises(InvalidValueError, match='a campaign of kind "overturning-map" has no fragility'):
        analyses(finished("overturning-map"))


def test_settings_reach_the_engine(text):
    """Gravity and the linear equations are those of the job."""
    job = Job.of_text(text("overturning-map") + "[settings]\ngravity = 1.62\nlinear = true\n")
    settings = job.study.histories.settings
    assert (settings.gravity, settings.linear) == (1.62, True)
    assert job.study.histories.key() != Job.of_text(text("overturning-map")).study.histories.key()


def test_key_knows_what_decides(text):
    """Names and chunks do not change the key; an axis, a model or a seed does."""
    whole = text("stripes")
    key = Job.of_text(whole).study.histories.key()
    assert Job.of_text(whole.replace("a small", "another").replace("[body]", "[body]\n")).study.histories.key() == key
    for old, new in (("seed = 4", "seed = 5"), ("to = 10", "to = 11"), ("width = 0.5", "width = 0.50001")):
        assert Job.of_text(whole.replace(old, new)).study.histories.key() != key


EXAMPLES = sorted(examples.path("stripes").parent.glob("*.toml"))


def test_examples():
    """Each example is taken, and computes without a failed history; they are of eight kinds."""
    kinds = set()
    for path in EXAMPLES:
        job = Job.read(path)
        kinds.add(job.document.campaign.kind)
        last = min(job.study.histories.count, 24)
        assert (job.study.histories.run(0, last, threads=1)["outcome"] < 3).all()
    assert kinds <= set(questions())
    assert len(kinds) >= 8
