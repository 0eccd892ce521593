"""Batches in space: shapes, refusals, isolation of rows, threads, engines, exports, falls."""

import itertools
import json
import math
import sys

import numpy as np
import pytest

import rocking as rk
from rocking import conventions
from rocking.dynamics import SpaceBatchSettings, SpaceSettings
from rocking.dynamics.rolling import SpatialBody, SpatialStart, fast_engine
from rocking.dynamics.rolling.batch import batch_in_space
from rocking.dynamics.rolling.fast_engine import batch_law
from rocking.dynamics.rolling.ground import ground_of
from rocking.dynamics.rolling.impact_laws import FixedSpatial
from rocking.errors import InvalidValueError, MissingExtraError, SlowEngineWarning, UnknownModelError
from rocking.outcome import Status
from rocking.plots import falling_picture

BOX = SpatialBody.box(0.5, 0.6, 2.0)
PULSE = rk.pulses.sine(amplitude=4.0, period=0.8)
TIME = np.arange(201) * 0.01
RECORD = rk.GroundMotion(4.0 * np.sin(6.0 * TIME), 0.01), rk.GroundMotion(3.0 * np.cos(5.0 * TIME), 0.01)
built = pytest.mark.skipif(not fast_engine.available(), reason="the batch engine was not built")


def _same(first, second):
    return all(np.array_equal(first[name], second[name], equal_nan=True) for name in first.values)


@built
def test_every_combination_has_a_place():
    """Five axes in the stated order, with results that follow the inputs along each of them."""
    bodies = [BOX, SpatialBody.box(2.0, 2.0, 1.0)]
    starts = [SpatialStart(), SpatialStart(0.05, 0.3)]
    batch = batch_in_space(bodies, [RECORD, PULSE], ["housner-3d", 0.9], scales=[0.0, 0.5, 1.0], start=starts)
    assert batch.outcome.shape == (2, 2, 3, 2, 2)
    assert len(batch) == 48
    assert (batch.outcome[:, :, 0, :, 0] == 0).all()  # no motion, no uplift
    assert (batch["uplifts"][0, :, :, :, 1] >= 1).all()  # let go while it leans
    assert (batch.outcome[1, :, :, :, 0] == 0).all()  # the squat body stays
    assert batch.outcome[0, 0, 2, 0, 0] != 0


@built
def test_a_bad_row_touches_no_other():
    """NaN and infinite scales and starts and an impossible body get a status; the other rows keep their bits."""
    good = batch_in_space([BOX], RECORD, scales=[0.5, 1.0], start=[SpatialStart(), SpatialStart(0.04)])
    top_heavy = {"mass": 1.0, "centre": (2.0, 0.0, 1.0), "inertia": np.eye(3), "base": BOX.base}
    bodies = [type("Loose", (), top_heavy)(), BOX]
    starts = [SpatialStart(), SpatialStart(math.nan), SpatialStart(0.04), SpatialStart(2.0)]
    mixed = batch_in_space(bodies, RECORD, scales=[math.nan, 0.5, math.inf, 1.0], start=starts)
    kept = np.ix_([1], [0], [1, 3], [0], [0, 2])
    for name in good.values:
        np.testing.assert_array_equal(mixed[name][kept], good[name], strict=True)
    bad = np.ones(mixed.shape, dtype=bool)
    bad[kept] = False
    assert (mixed.status[bad] == Status.INVALID.code).all()
    assert np.isnan(mixed["peak_tilt"][bad]).all()
    assert "above the base" in mixed.refused[0]
    assert (good.status == Status.GOOD.code).all() or (good.overturned == 1.0).any()
    refused = [batch_in_space(bodies, RECORD, scales=[math.nan], engine=engine) for engine in ("fast", "reference")]
    for name, values in refused[0].values.items():
        np.testing.assert_array_equal(refused[1].values[name], values, strict=True)


@built
def test_threads_pieces_and_order_leave_the_bits(monkeypatch):
    """One thread or three, pieces of any size, rows forwards or backwards: the same bits; another step is not."""
    bodies = [SpatialBody.box(0.4 + 0.05 * k, 0.5, 1.8) for k in range(6)]
    first = batch_in_space(bodies, RECORD, scales=[0.6, 0.9], threads=1)
    assert _same(first, batch_in_space(bodies, RECORD, scales=[0.6, 0.9], threads=3))
    calls = []
    monkeypatch.setattr(fast_engine, "PIECE", 5)
    assert _same(first, batch_in_space(bodies, RECORD, scales=[0.6, 0.9], threads=2, progress=calls.append))
    assert calls == [5, 5, 2]
    back = batch_in_space(bodies[::-1], RECORD, scales=[0.9, 0.6])
    for name in first.values:
        np.testing.assert_array_equal(back[name][::-1, :, ::-1], first[name])
    other = batch_in_space(bodies, RECORD, scales=[0.6, 0.9], settings=SpaceBatchSettings(tolerance=1e-8))
    assert not _same(first, other)


@pytest.mark.slow
@built
def test_the_reference_engine_serves_row_by_row():
    """Both engines give the same outcomes and counts, and the same numbers to 1e-6, refusals included."""
    bodies = [BOX, SpatialBody.box(0.7, 0.5, 2.5)]
    starts = [SpatialStart(), SpatialStart(0.03, 0.7), SpatialStart(math.nan)]
    given, told = {"scales": [0.8, 2.5], "start": starts}, []
    fast = batch_in_space(bodies, RECORD, ["housner-3d", "ked-3d", 0.9], **given)
    given |= {"engine": "reference", "progress": told.append}
    slow = batch_in_space(bodies, RECORD, ["housner-3d", "ked-3d", 0.9], **given)
    assert sum(told) == slow.status.size
    assert "reference" in slow.engine
    for name in ("outcome", "status", "over_contact", "over_number", "impacts", "uplifts", "events"):
        np.testing.assert_array_equal(fast[name], slow[name], err_msg=name)
    for name in ("peak_tilt", "peak_time", "overturning_time", "first_uplift", "energy_lost", "direction"):
        if name == "direction":  # where the last step ends differs, and the body goes on turning
            np.testing.assert_allclose(
                np.cos(fast[name] - slow[name])[slow.overturned == 1.0], 1.0, rtol=0.0, atol=0.05
            )
            continue
        np.testing.assert_allclose(fast[name], slow[name], rtol=1e-6, atol=1e-7, err_msg=name)


@built
def test_still_ground_ends_at_rest():
    """A body that is let go on ground at rest comes to rest and stays: rocked, with no end of the motion given."""
    batch = batch_in_space(BOX, start=SpatialStart(0.02, 0.4))
    assert batch.outcome.item() == rk.Outcome.ROCKED.code
    assert batch["impacts"].item() > 10
    pushed = batch_in_space(BOX, start=SpatialStart(angular_velocity=(0.0, 3.0, 0.0)))
    assert pushed.overturned.item() == 1.0
    assert pushed["direction"].item() == pytest.approx(0.0, abs=1e-9)


@built
@pytest.mark.parametrize("size", [1.0, 50.0])
def test_ground_at_rest_is_followed_for_300_over_p(size):
    """A slender box that loses nothing, let go at half its slenderness angle, meets the ground first after
    acosh(2) / p and then every 2 acosh(2) / p: 114 times, whatever its size; half as long, half as often."""
    body = SpatialBody.box(0.2 * size, 0.2 * size, 4.0 * size)
    start = SpatialStart(0.5 * math.atan(0.05))
    p = math.sqrt(0.75 * conventions.g / (size * math.hypot(0.1, 2.0)))
    half = math.acosh(2.0)
    for duration, length in ((None, 300.0), (150.0 / p, 150.0)):
        batch = batch_in_space(body, None, 1.0, start=start, duration=duration)
        assert batch["impacts"].item() == pytest.approx((length + half) / (2.0 * half), abs=1.5)


@built
@pytest.mark.parametrize("sides", [3, 8, 20, 65])
def test_bases_of_many_sides(sides):
    """Regular polygons of any number of sides; more than 64 vertices are refused in words."""
    angle = 2.0 * np.pi * np.arange(sides) / sides
    base = 0.3 * np.column_stack([np.cos(angle), np.sin(angle)])
    body = SpatialBody(100.0, np.array([0.0, 0.0, 1.0]), np.diag([40.0, 40.0, 5.0]), base)
    if sides > 64:
        with pytest.raises(InvalidValueError, match="at most 64"):
            batch_in_space(body, RECORD)
    else:
        assert batch_in_space(body, RECORD)["uplifts"].item() > 0


def test_laws_by_name_number_and_object():
    """Every way of saying a law gives its number; foreign laws are refused and named."""
    assert [batch_law(law).code for law in ("housner-3d", "horizontal-momentum-3d", 0.9, "ked-3d", "ked-3d-point")] == [
        *range(5)
    ]
    assert batch_law(FixedSpatial(0.8)).coefficient == 0.8

    class Bouncy:
        label = "bouncy"

        def velocity_after(self, body, impact):
            return impact.velocity

    with pytest.raises(InvalidValueError, match="bouncy"):
        batch_law(Bouncy())
    with pytest.raises(UnknownModelError):
        batch_law("no such law")


@pytest.mark.slow
@built
def test_ked_without_matter_is_a_status():
    """A body that does not know of what it consists cannot take ked-3d; its rows say so, others go on."""
    bare = SpatialBody(BOX.mass, BOX.centre, BOX.inertia, BOX.base)
    for law in ("ked-3d", "ked-3d-point"):
        batch = batch_in_space([bare, BOX], RECORD, law)
        assert batch.status.ravel().tolist()[0] == Status.INVALID.code
        assert batch.status.ravel().tolist()[1] != Status.INVALID.code


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"bodies": []}, "bodies"),
        ({"motions": []}, "motions"),
        ({"motions": (PULSE, None, None, None)}, "three components"),
        ({"scales": []}, "scales"),
        ({"start": [0.1]}, "SpatialStart"),
        ({"engine": "quick"}, "engine"),
        ({"threads": 0}, "threads"),
        ({"progress": 3}, "progress"),
        ({"duration": -1.0}, "duration"),
    ],
)
def test_arguments_out_of_range_are_named(change, words):
    """Every refused argument appears in the message."""
    if "threads" in change and not fast_engine.available():
        pytest.skip("the batch engine was not built")
    with pytest.raises(InvalidValueError, match=words):
        batch_in_space(**({"bodies": BOX, "motions": PULSE} | change))


def test_without_the_compiled_engine_the_reference_serves(monkeypatch):
    """Asked for by name it is an error that says what to do; otherwise a warning, and the reference engine."""
    monkeypatch.setitem(sys.modules, "rocking.dynamics._spatial", None)
    with pytest.raises(MissingExtraError, match="make engine"):
        batch_in_space(BOX, PULSE, engine="fast")
    with pytest.warns(SlowEngineWarning, match="row by row"):
        batch = batch_in_space(BOX, PULSE, scales=0.1)
    assert "reference" in batch.engine


@built
def test_an_instruction_set_that_is_not_there_is_refused(monkeypatch):
    """ROCKING_ISA chooses; every set gives the same outcomes."""
    found = []
    for isa in fast_engine.module().instruction_sets():
        monkeypatch.setenv("ROCKING_ISA", isa)
        found.append(batch_in_space(BOX, RECORD, scales=[0.5, 1.0, 2.0]))
        assert isa in found[-1].engine
    for first, second in itertools.pairwise(found):
        np.testing.assert_array_equal(first.outcome, second.outcome)
        np.testing.assert_allclose(first["peak_tilt"], second["peak_tilt"], rtol=1e-6)
    monkeypatch.setenv("ROCKING_ISA", "abacus")
    with pytest.raises(InvalidValueError, match="abacus"):
        batch_in_space(BOX, RECORD)


@pytest.mark.parametrize("until", [math.inf, 1.234, 0.5])
def test_components_with_one_step_stay_as_they_are(until):
    """Records of one step are not cut anew, whatever their lengths; beside another step they are, to rounding."""
    short = rk.GroundMotion(np.cos(TIME[:77]), 0.01)
    for parts in ((RECORD[0], short), (None, RECORD[0], short), (short, None, RECORD[1])):
        found = ground_of(*parts, until=until)
        for which, part in ((k, part) for k, part in enumerate(parts) if part is not None):
            lines = part.segments().horizontal[: found.count]
            np.testing.assert_array_equal(found.coefficients[: len(lines), which], lines)
            assert not found.coefficients[len(lines) :, which].any()
    cut = ground_of(RECORD[0], rk.GroundMotion(np.zeros(300), 0.007), until=until)
    inside = np.linspace(0.0, 0.99 * min(until, 2.0), 500)
    assert cut.count > ground_of(RECORD[0], until=until).count
    np.testing.assert_allclose(cut.at(inside)[:, 0], ground_of(RECORD[0]).at(inside)[:, 0], atol=1e-12)


@pytest.mark.parametrize(
    "wrong",
    [
        {"tilt": 0.5 * math.pi},
        {"tilt": -1e-9},
        {"angular_velocity": (0.0, math.inf)},
        {"tilt": math.nan},
        {"azimuth": math.inf},
        {"yaw": math.nan},
        {"angular_velocity": (0.0, 1.0)},
        {"angular_velocity": (0.0, math.nan, 0.0)},
        {"angular_velocity": (0.0, 0.0, math.inf)},
    ],
)
def test_a_start_knows_whether_it_can_be(wrong):
    """Tilts from zero to below a quarter turn and finite numbers; anything else is refused by the row."""
    assert SpatialStart(0.2, 7.0, -3.0, (0.1, -20.0, 3.0)).valid
    assert not SpatialStart(**wrong).valid
    if fast_engine.available():
        batch = batch_in_space(BOX, None, start=[SpatialStart(**wrong), SpatialStart(0.02)], duration=0.1)
        assert batch.status.ravel().tolist()[0] == Status.INVALID.code
        assert batch.status.ravel().tolist()[1] == Status.GOOD.code


def test_settings_of_the_batch_are_those_of_one_history():
    """But for step and tolerance, which each engine has its own."""
    batch, one = SpaceBatchSettings(), SpaceSettings()
    for name in ("gravity", "rest_speed", "most_events"):
        assert getattr(batch, name) == getattr(one, name)


@pytest.fixture(scope="module")
def batch():
    """Two bodies, two scales, two laws, two starts; the second body is none."""
    loose = type("Loose", (), {"mass": 1.0, "centre": (2.0, 0.0, 1.0), "inertia": np.eye(3), "base": BOX.base})()
    starts = [SpatialStart(), SpatialStart(0.05, 0.3)]
    return batch_in_space([BOX, loose], (PULSE, PULSE), ["housner-3d", 0.9], scales=[0.5, 2.5], start=starts)


@pytest.mark.slow
@built
def test_a_dataset_has_axes_units_and_provenance(batch, tmp_path):
    """The five axes, the arrays, their units, and of what all was computed, also back from a netCDF file."""
    import xarray

    batch.to_xarray().to_netcdf(tmp_path / "batch.nc", engine="h5netcdf")
    with xarray.open_dataset(tmp_path / "batch.nc", engine="h5netcdf") as data:
        assert data["peak_tilt"].dims == ("body", "motion", "scale", "restitution", "start")
        np.testing.assert_array_equal(data["peak_tilt"].values, batch["peak_tilt"])
        assert np.isnan(data["peak_tilt"].values[1]).all()
        assert data["energy_lost"].attrs["units"] == "J"
        assert list(data["restitution"].values) == ["housner-3d", "0.9"]
        assert set(data.data_vars) == {*batch.values, "overturned"}
        assert "fast" in data.attrs["engine"]
        told = data.attrs
    assert told["software"] == f"rocking {rk.__version__}"
    assert told["setting_gravity"] == conventions.g
    assert json.loads(told["bodies"])[0]["mass"] == BOX.mass
    assert json.loads(told["bodies"])[1] is None
    assert "1" in json.loads(told["refused"])
    assert json.loads(told["starts"])[1][:2] == [0.05, 0.3]


@built
def test_another_body_has_another_digest(batch):
    """The digest stands for the bodies: the same again, another with a millimetre more."""
    same = batch_in_space([BOX], PULSE).provenance["bodies_sha256"]
    assert same == batch_in_space([BOX], PULSE, scales=2.0).provenance["bodies_sha256"]
    other = batch_in_space([SpatialBody.box(0.501, 0.6, 2.0)], PULSE).provenance["bodies_sha256"]
    assert same != other


TALL_BOX = SpatialBody.box(0.5, 0.4, 2.0)
ANGLES = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
MOTIONS = [(PULSE.scaled(np.cos(a)), PULSE.scaled(np.sin(a))) for a in ANGLES]


@pytest.mark.slow
@built
def test_lines_show_the_share_of_scales():
    """The two lines of the first panel are the shares of overturning in percent, closed round; a control is not."""
    batch = rk.simulate_many(TALL_BOX, MOTIONS, ["housner-3d", 0.95], scale=np.linspace(0.5, 3.0, 9))
    figure = falling_picture(batch, ANGLES, [(0.25, 0.2), (-0.25, 0.2), (-0.25, -0.2), (0.25, -0.2)])
    share = 100.0 * batch["overturned"].mean("scale").values[0, :, :, 0]
    assert 0.0 < share.mean() < 100.0
    for k, line in enumerate(figure.axes[0].lines):
        drawn = np.asarray(line.get_ydata())
        np.testing.assert_allclose(drawn, np.append(share[:, k], share[0, k]))
        assert np.abs(drawn[:-1] - np.roll(share[:, k], 1)).max() > 0.0  # negative control
    assert figure.axes[0].get_legend().get_texts()[1].get_text() == "r = 0.95"


@built
def test_a_batch_of_another_shape_is_refused():
    """One restitution, or fewer azimuths than motions: an error that shows the shape."""
    with pytest.raises(InvalidValueError, match="two restitutions"):
        falling_picture(rk.simulate_many(TALL_BOX, MOTIONS), ANGLES)
    two = rk.simulate_many(TALL_BOX, MOTIONS, ["housner-3d", 0.9])
    with pytest.raises(InvalidValueError, match="each of 5"):
        falling_picture(two, ANGLES[:5])
