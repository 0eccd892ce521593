"""The contact bed fitted to measurements: known beds are found again, rankings follow from their numbers."""

from dataclasses import replace

import numpy as np
import pytest

from rocking.evidence import all_measurements, datasets, league
from rocking.evidence._league import contact_bed
from rocking.evidence.bed_fit import (
    BedFit,
    Explanation,
    Ranked,
    bed_coefficients,
    explanation,
    explanations,
    fit_bed,
    left_out,
    relative_width,
)
from rocking.evidence.likelihood import interval_log_likelihood, scatter
from rocking.evidence.measurements import GROUPS
from rocking.restitution import ContactBedModel

pytestmark = pytest.mark.slow

PHYSICS = {each.name: each for each in explanations()}


def simulated(name, values, points, *, floor=0.02, seed=3, decimals=3):
    """The 39 slendernesses with coefficients of a known bed, scatter, and rounding to three digits."""
    data = all_measurements()
    mean = PHYSICS[name].predict(np.array(values), data, points)
    sd = scatter(mean, floor, 1.0)
    r = np.round(mean + sd * np.random.default_rng(seed).standard_normal(len(data)), decimals)
    half = 0.5 * 10.0**-decimals
    return replace(data, coefficient=r, low=r - half, high=r + half)


def test_the_bed_of_the_fit_is_the_model():
    """Predictions for whole bases are those of the registered model."""
    ratios = np.array([1.5, 3.0, 9.75])
    for points, damping, hardness in ((5, 1.0, 100.0), (41, 2.5, 700.0)):
        expected = ContactBedModel(points, damping, hardness).of_slenderness(ratios)
        assert bed_coefficients(ratios, points, damping, hardness) == pytest.approx(expected, rel=1e-12, abs=0.0)
    # a bed on half the base is the bed of a block of twice the slenderness and the inertia of this one
    assert (bed_coefficients(ratios, 5, 1.0, 100.0, share=0.5) > bed_coefficients(ratios, 5, 1.0, 100.0)).all()


def test_every_explanation_says_what_it_computes():
    """Row by row, each physics is the bed with what its sentence says of that row's group, mass or width."""
    data = all_measurements()
    zeta, hard, x, y, z, w = 1.4, 90.0, 0.91, 0.94, 0.97, 0.99
    by_group = dict(zip(("S", "M", "L"), (x, y, z), strict=True))
    dampings = dict(zip(GROUPS, (1.1, 1.3, 1.6, 1.9), strict=True))
    hardnesses = dict(zip(GROUPS, (60.0, 90.0, 130.0, 180.0), strict=True))

    def bed(row, damping=zeta, hardness=hard, **more):
        return bed_coefficients(data.slenderness[[row]], 5, damping, hardness, **more)[0]

    def unshaken(name):
        return name == "table1"

    expected = {
        "one bed": ((zeta, hard), lambda row, name: bed(row)),
        "additional loss on tape": (
            (zeta, hard, w),
            lambda row, name: bed(row) * (1.0 if unshaken(name) else w),
        ),
        "loss independent of mass": (
            (zeta, hard, 0.03),
            lambda row, name: bed(row) * (1.0 if unshaken(name) else np.sqrt(1.0 - 0.03 / data.mass[row])),
        ),
        "loss by group": ((zeta, hard, x, y, z), lambda row, name: bed(row) * by_group.get(name, 1.0)),
        "damping by group": ((hard, *dampings.values()), lambda row, name: bed(row, damping=dampings[name])),
        "hardness by group": ((zeta, *hardnesses.values()), lambda row, name: bed(row, hardness=hardnesses[name])),
        "narrower base by group": (
            (zeta, hard, x, y, z),
            lambda row, name: bed(row, share=by_group.get(name, 1.0)),
        ),
        "unevenness of one height": (
            (zeta, hard, 0.2),
            lambda row, name: bed(row, shift=0.0 if unshaken(name) else 0.2 / relative_width(data)[row]),
        ),
    }
    assert set(expected) == set(PHYSICS)
    groups = ("S", "M", "L")
    fitted = {
        "one bed": ("damping", "hardness"),
        "additional loss on tape": ("damping", "hardness", "eta"),
        "loss independent of mass": ("damping", "hardness", "tape"),
        "loss by group": ("damping", "hardness", *(f"eta {group}" for group in groups)),
        "damping by group": ("hardness", "damping Table 1", *(f"damping {group}" for group in groups)),
        "hardness by group": ("damping", "hardness Table 1", *(f"hardness {group}" for group in groups)),
        "narrower base by group": ("damping", "hardness", *(f"share {group}" for group in groups)),
        "unevenness of one height": ("damping", "hardness", "uneven"),
    }
    assert {name: tuple(one.name for one in each.parameters) for name, each in PHYSICS.items()} == fitted
    for name, (values, of_row) in expected.items():
        found = PHYSICS[name].predict(np.array(values), data, 5)
        assert found == pytest.approx(
            [of_row(row, group) for row, group in enumerate(data.group)], rel=1e-12, abs=0.0
        ), name
        assert len(values) == len(PHYSICS[name].parameters)
        assert all(one.bounds[0] <= one.start <= one.bounds[1] for one in PHYSICS[name].parameters)


def test_factors_are_found_again():
    """Factors of .95, .97 and .99 by group come back within .005 from 39 simulated rows, and so do the points."""
    data = simulated("loss by group", [1.5, 100.0, 0.95, 0.97, 0.99], 5)
    fit = fit_bed(PHYSICS["loss by group"], data, points=(2, 5))
    assert fit.points == 5
    found = [fit.values[f"eta {name}"] for name in ("S", "M", "L")]
    assert found == pytest.approx([0.95, 0.97, 0.99], abs=0.005)  # scatter .02 (1 - r) on nine rows each
    # negative control: one bed for all cannot follow them
    assert fit_bed(PHYSICS["one bed"], data, points=(5,)).bic > fit.bic + 10.0


def test_a_tape_is_told_from_factors():
    """Rows made with a loss that falls as 1/mass prefer that explanation, and its size comes back."""
    data = simulated("loss independent of mass", [1.5, 100.0, 0.03], 5)
    tape = fit_bed(PHYSICS["loss independent of mass"], data, points=(5,))
    assert tape.values["tape"] == pytest.approx(0.03, abs=0.003)
    assert tape.bic < fit_bed(PHYSICS["additional loss on tape"], data, points=(5,)).bic - 10.0


def test_without_a_mass_effect_one_bed_wins():
    """Rows of one bed do not prefer a factor by group."""
    data = simulated("one bed", [1.5, 100.0], 5)
    assert fit_bed(PHYSICS["one bed"], data, points=(5,)).bic < fit_bed(PHYSICS["loss by group"], data, points=(5,)).bic


def test_numbers_of_a_fit_agree():
    """Likelihood, BIC and RMSE of a fit follow from its predictions."""
    data = all_measurements()
    fit = fit_bed(PHYSICS["one bed"], points=(5,))
    sd = scatter(fit.predicted, fit.floor, fit.slope)
    log_likelihood = interval_log_likelihood(data.low, data.high, fit.predicted, sd).sum()
    assert fit.log_likelihood == pytest.approx(log_likelihood, rel=1e-9)
    assert fit.bic == pytest.approx(5 * np.log(39) - 2.0 * log_likelihood, rel=1e-12, abs=0.0)
    assert fit.rmse == pytest.approx(np.sqrt(np.mean((fit.predicted - data.coefficient) ** 2)), rel=1e-12, abs=0.0)
    scores = left_out([fit])
    # what was not seen is less likely than what was
    assert scores.sum() < fit.log_likelihood


def test_widths_are_ratios():
    """(mass / slenderness)^(1/3): eight times the mass at one slenderness is twice the width; Table 1 has none."""
    group = datasets()["S"]
    heavier = replace(group, mass=8.0 * group.mass)
    assert relative_width(heavier) == pytest.approx(2.0 * relative_width(group), rel=1e-12, abs=0.0)
    assert np.isinf(relative_width(datasets()["table1"])).all()


def test_bed_in_the_league():
    """The fitted bed of the league is no worse than its default, nor than its own family with a factor."""
    rows = {row.name: row for row in league()}
    fitted, factored = (rows[contact_bed(eta=eta).name] for eta in (False, True))
    default = rows[ContactBedModel().label]
    assert factored.rmse <= fitted.rmse <= default.rmse
    r = fitted.model.of_slenderness(all_measurements().slenderness)
    assert fitted.rmse == pytest.approx(np.sqrt(np.mean((r - all_measurements().coefficient) ** 2)), rel=1e-9)
    assert set(fitted.parameters) == {"points", "hardness"}


def test_ranking_and_verdict():
    """Explanations stand in the order of BIC, and the words follow from the numbers."""
    found = explanation()
    behind = [each.behind for each in found.ranked]
    assert behind == sorted(behind)
    assert behind[0] == 0.0
    assert found.ranked[0].name in found.verdict[0]
    assert f"{found.plain.behind:.1f}" in found.verdict[0]
    shares = found.shares_lost
    assert f"{100.0 * shares['S']:.1f} % (S)" in found.verdict[3]


def test_a_tie_is_called_a_tie():
    """Two explanations within two of BIC are said to be undecided, and no left-out gain is said to be none."""
    found = explanation()
    plain, best = found.plain, found.ranked[0]
    none = np.zeros(39)
    near = tuple(
        Ranked(each.fit, none, 0.0 if each is best else 1.0, 0.0, 0.0) for each in (best, plain) if each is not None
    )
    tied = Explanation(near)
    assert tied.unresolved == (best.name, plain.name)
    assert "do not distinguish" in tied.verdict[1]
    assert "not resolved" in tied.verdict[2]


def test_two_of_bic_and_two_standard_errors_decide():
    """Undecided is what lies less than 2 of BIC behind; better unseen is what gains over two of its standard errors."""
    none = np.zeros(39)
    fits = [BedFit(each, 5, {}, 0.02, 1.0, 0.0, 0.0, 0.0, none) for each in PHYSICS.values()]
    told = {0: (0.0, 0.9, 0.4), 1: (1.9, 0.1, 0.06), 2: (2.1, 2.5, 1.0), 3: (9.0, -0.9, 0.1), 4: (9.5, 0.0, 0.0)}
    found = Explanation(
        tuple(Ranked(fits[i], none, behind, gain, gain_error) for i, (behind, gain, gain_error) in told.items())
    )
    names = [fit.physics.name for fit in fits]
    assert found.unresolved == tuple(names[:2])
    assert found.better_unseen == (names[0], names[2])


def test_parameters_at_the_ends_of_their_ranges_are_named():
    """Within two thousandths of a range from either of its ends a fit has been pushed to a limit; in between not."""
    physics = PHYSICS["unevenness of one height"]
    ranges = {one.name: one.bounds for one in physics.parameters}
    inside = {name: low + 0.3 * (high - low) for name, (low, high) in ranges.items()}
    for name, (low, high) in ranges.items():
        for share, told in ((0.0, True), (0.0015, True), (0.003, False), (0.997, False), (0.9985, True), (1.0, True)):
            values = {**inside, name: low + share * (high - low)}
            fit = BedFit(physics, 5, values, 0.02, 1.0, 0.0, 0.0, 0.0, np.zeros(39))
            assert fit.at_a_limit == ((name,) if told else ())


def test_widths_are_those_of_the_mass():
    """A block twice as wide and as deep, three times as slender: 2 x 2 x 6 times the mass, at any unit of mass."""
    data = all_measurements().rows([0, 1])
    data = replace(data, mass=np.array([5.0, 5.0 * 24.0]), slenderness=np.array([2.0, 6.0]))
    narrow, wide = relative_width(data)
    assert wide / narrow == pytest.approx(2.0, rel=1e-14, abs=0.0)
