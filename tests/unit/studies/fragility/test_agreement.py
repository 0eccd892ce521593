"""Goodness of fit and bootstrap intervals that go with curves into files, against textbook formulas."""

import csv
import math

import numpy as np
import pytest
from scipy.io import loadmat
from scipy.special import ndtr
from scipy.stats import norm

from rocking.statistics import fit_lognormal
from rocking.statistics.bootstrap import _order_statistic
from rocking.statistics.goodness import STATISTICS, agreement_of, repeated_of
from rocking.studies.fragility import FragilityModel, to_csv, to_excel, to_mat, to_netcdf
from rocking.studies.fragility.curves import curve_of, with_common_dispersion, with_evidence
from rocking.studies.fragility.export import table

LEVELS = np.exp(np.linspace(-1.0, 1.0, 9))
TRIALS = np.full(9, 400)
RIGHT = np.round(400 * ndtr(LEVELS_U := np.log(LEVELS) / 0.6))
SATURATED = np.round(400 * 0.6 * ndtr((np.log(LEVELS) + 0.5) / 0.25))


def model_from(reached, *, bootstrap=0, seed=3, without=None):
    """Return a model of one state, as an analysis makes it."""
    fit = fit_lognormal(LEVELS, reached, TRIALS)
    curve = with_evidence(curve_of("overturned", fit), fit, LEVELS, bootstrap, seed)
    return FragilityModel(
        "a block", "pga", "m/s2", (curve,), LEVELS, TRIALS, {"overturned": reached}, "a study", without=without or {}
    )


def textbook(reached, median, dispersion):
    """Deviance and Pearson's statistic by the formulas of any textbook, and the largest distance of shares."""
    p = norm.cdf(np.log(LEVELS / median) / dispersion)
    left = TRIALS - reached
    with np.errstate(divide="ignore", invalid="ignore"):
        parts = [np.where(z > 0, z * np.log(z / (TRIALS * q)), 0.0) for z, q in ((reached, p), (left, 1.0 - p))]
    pearson = np.sum((reached - TRIALS * p) ** 2 / (TRIALS * p * (1.0 - p)))
    return {
        "deviance": 2.0 * np.sum(parts), "pearson": pearson, "hosmer_lemeshow": pearson,
        "kolmogorov": np.max(np.abs(reached / TRIALS - p)),
    }  # fmt: skip


def read(made, path, end):
    """Return what a file says of the one state: a function of the name of a number."""
    if end == ".csv":
        with to_csv(made, path).open(encoding="utf-8") as file:
            (row,) = csv.DictReader(file)
        return lambda name: float(row[name.replace("_p_value", " p-value") + " [-]"])
    if end == ".xlsx":
        openpyxl = pytest.importorskip("openpyxl")
        header, row = openpyxl.load_workbook(to_excel(made, path))["parameters"].iter_rows(values_only=True)
        cells = dict(zip(header, row, strict=True))
        return lambda name: cells[name.replace("_p_value", " p-value") + " [-]"]
    if end == ".mat":
        structure = loadmat(to_mat(made, path), squeeze_me=True, struct_as_record=False)["fragility"]
        return lambda name: float(getattr(structure, name))
    xr = pytest.importorskip("xarray")
    found = xr.load_dataset(to_netcdf(made, path), engine="h5netcdf")
    return lambda name: float(found[name].values[0])


@pytest.mark.slow
@pytest.mark.parametrize("end", [".csv", ".xlsx", ".mat", ".nc"])
def test_goodness_of_fit_in_every_format(tmp_path, end):
    """Statistics in files are those of the textbook; a right curve has large p-values, a wrong one small ones."""
    for reached, right in ((RIGHT, True), (SATURATED, False)):
        made = model_from(reached)
        number = read(made, tmp_path / f"f{end}", end)
        wanted = textbook(reached, made.curves[0].median, made.curves[0].dispersion)
        for name in STATISTICS:
            # Excel keeps 15 digits and a bit
            assert number(name) == pytest.approx(wanted[name], rel=1e-9, abs=1e-12)
            p_value = number(f"{name}_p_value")
            assert p_value > 0.3 if right else p_value < 0.01


def information():
    """Fisher information of (ln median, ln dispersion) of the right curve, by the chain rule."""
    z = LEVELS_U
    weight = TRIALS * norm.pdf(z) ** 2 / (ndtr(z) * ndtr(-z))
    slope = np.stack([np.full_like(z, -1.0 / 0.6), -z])  # of z with respect to ln median and ln dispersion
    return (slope * weight) @ slope.T


def test_bootstrap_is_as_wide_as_theory():
    """Ends of intervals and band are 1.96 standard errors of the Fisher information away."""
    found = model_from(RIGHT, bootstrap=4000).curves[0].repeated
    covariance = np.linalg.inv(information())
    # 4000 repetitions know an end to 4 % of its distance
    for ends, error in ((found.median_95, covariance[0, 0]), (found.dispersion_95, covariance[1, 1])):
        assert math.log(ends[1] / ends[0]) == pytest.approx(2.0 * 1.96 * math.sqrt(error), rel=0.08)
    z = LEVELS_U
    slope = np.stack([np.full_like(z, -1.0 / 0.6), -z])
    half = 1.96 * norm.pdf(z) * np.sqrt(np.sum(slope * (covariance @ slope), axis=0))
    middle = slice(2, 7)  # in the tails a symmetric interval is none
    np.testing.assert_allclose(((found.band[1] - found.band[0]) / 2.0)[middle], half[middle], rtol=0.1)
    quarter = fit_lognormal(LEVELS, np.round(RIGHT / 4), TRIALS / 4)
    wide = repeated_of(quarter, LEVELS, 4000, 3).median_95
    # negative control: a quarter of the data is not that precise
    assert math.log(wide[1] / wide[0]) > 1.8 * math.log(found.median_95[1] / found.median_95[0])


@pytest.mark.slow
@pytest.mark.parametrize("end", [".csv", ".mat", ".nc"])
def test_bootstrap_in_files(tmp_path, end):
    """Bootstrap intervals stand in the files only where they were asked for, with kind, number and seed."""
    made, plain = model_from(RIGHT, bootstrap=200), model_from(RIGHT)
    told = made.curves[0].repeated
    assert told.basis == "parametric, 200 repetitions, seed 3, studentised ends"
    if end == ".csv":
        text = to_csv(made, tmp_path / "f.csv").read_text(encoding="utf-8")
        assert all(repr(value) in text for value in (*told.median_95, *told.dispersion_95))
        assert told.basis in text
        points = table(made, "points")
        column = points.header.index("bootstrap 95 % to overturned [-]")
        assert [row[column] for row in points.rows] == told.band[1].tolist()
        assert "bootstrap" not in to_csv(plain, tmp_path / "g.csv").read_text(encoding="utf-8")
        assert not any("bootstrap" in name for name in table(plain, "points").header)
    elif end == ".mat":
        found = loadmat(to_mat(made, tmp_path / "f.mat"), squeeze_me=True, struct_as_record=False)["fragility"]
        assert tuple(found.median_bootstrap_95) == told.median_95
        assert np.array_equal(found.probability_bootstrap_95, np.stack(told.band))
        assert found.bootstrap == told.basis
    else:
        xr = pytest.importorskip("xarray")
        found = xr.load_dataset(to_netcdf(made, tmp_path / "f.nc"), engine="h5netcdf")
        assert tuple(found["dispersion_bootstrap_95"].sel(end=["low", "high"]).values[0]) == told.dispersion_95
        assert found["median_bootstrap_95"].attrs["units"] == "m/s2"
        assert "median_bootstrap_95" not in plain.dataset


def test_seed_decides():
    """The same seed gives the same numbers, another one others."""
    one, same, other = (model_from(RIGHT, bootstrap=200, seed=seed).curves[0] for seed in (3, 3, 4))
    assert one.repeated.median_95 == same.repeated.median_95 != other.repeated.median_95
    assert one.agreement == same.agreement
    assert one.agreement.numbers["pearson"][0] == other.agreement.numbers["pearson"][0]


def test_honest_where_there_is_nothing(tmp_path):
    """No curve: a row with the reason and no numbers; one dispersion for all: no goodness of another curve."""
    none = fit_lognormal(LEVELS, np.zeros(9), TRIALS)
    assert curve_of("overturned", none) is None
    made = model_from(RIGHT, bootstrap=200, without={"rotation > 0.5 alpha": none.verdict})
    with to_csv(made, tmp_path / "f.csv").open(encoding="utf-8") as file:
        rows = {row["state"]: row for row in csv.DictReader(file)}
    row = rows["rotation > 0.5 alpha"]
    assert row["verdict"] == none.verdict
    assert (row["method"], row["histories"]) == ("none", "3600")
    assert not any(cell for name, cell in row.items() if any(word in name for word in ("median", "disp", "deviance")))
    assert made.dataset.attrs["without_curve rotation > 0.5 alpha"] == none.verdict
    found = loadmat(to_mat(made, tmp_path / "f.mat"), squeeze_me=True, struct_as_record=False)["fragility"]
    assert found.without_curve.reason == none.verdict
    common = with_common_dispersion(made)
    assert common.curves[0].agreement is common.curves[0].repeated is None
    assert np.isnan(common.dataset["pearson"].values).all()


def test_too_few_clusters_and_too_many_levels():
    """Four motions cannot be drawn again, and ten thousand levels times 1000 are not drawn unasked: words say so."""
    reached = np.array([[0, 0, 1, 1], [0, 1, 1, 1], [0, 0, 0, 1], [0, 1, 0, 1]])
    fit = fit_lognormal(np.tile([1.0, 2.0, 3.0, 4.0], 4), reached.ravel(), clusters=np.repeat(range(4), 4).tolist())
    few = repeated_of(fit, fit.counts.levels, 200)
    assert few.median_95 is few.band is None
    assert few.basis.startswith("none: kind must not be 'clusters' for 4 distinct clusters")
    assert agreement_of(fit).basis.endswith("they assume independent outcomes of each motion")
    random = np.random.default_rng(1)
    levels = np.exp(random.normal(size=25_000))
    many = fit_lognormal(levels, random.random(levels.size) < ndtr(np.log(levels)))
    assert np.isnan(list(agreement_of(many).numbers.values())).all()
    assert agreement_of(many).basis.startswith("none: 25000 levels are too many")
    assert repeated_of(many, many.counts.levels, 3000).basis.startswith("none: 3000 repetitions at 25000 levels")


def test_ends_that_are_open_are_nothing():
    """Repetitions without a curve leave the interval open at both sides: no number, neither 0 nor infinity."""
    found = repeated_of(fit_lognormal([1, 2, 3, 4], [0, 1, 1, 1], [2, 2, 2, 1]), np.array([1.0, 2.0]), 200)
    assert found.median_95 == found.dispersion_95 == (None, None)


def test_an_order_statistic_is_rounded_outwards():
    """Of 19 values, which cut a line in 20 equal parts, the lowest has 1/20 below it; with less nothing is known."""
    values = np.random.default_rng(2).permutation(19.0 * np.arange(19.0)).reshape(19, 1)
    assert [_order_statistic(values, share)[0] for share in (0.05, 0.5, 0.549, 0.55)] == [0.0, 171.0, 171.0, 190.0]
    assert _order_statistic(values, 0.049)[0] == -np.inf
