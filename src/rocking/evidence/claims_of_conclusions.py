"""Claims of section 4 of the paper, and what it concludes for engineering."""

from collections.abc import Callable

import numpy as np

from rocking.evidence._errata import closer_rows
from rocking.evidence.agreement import rmse
from rocking.evidence.claim import IN_PART, UNTESTABLE, Claim, all_or_open, truth
from rocking.evidence.comparison import compare, errors_of_groups
from rocking.evidence.measurements import all_measurements
from rocking.restitution import HorizontalMomentum, Ked
from rocking.studies.impact_laboratory import large_bodies


def _outperforms() -> Claim:
    parts = [truth(name) for name in ("table1", "S", "M", "L")]
    data = all_measurements()
    housner, ked = (np.concatenate([part[i] for part in parts]) for i in (1, 2))
    won = [closer for part, _, _ in parts for closer in closer_rows(part)]
    slender = [bool(ratio > 6.0) for part, _, _ in parts for ratio in part.slenderness]
    above = sum(closer and beyond for closer, beyond in zip(won, slender, strict=True))
    simple = HorizontalMomentum().of_slenderness(data.slenderness)
    return Claim(
        "4",
        "the proposed model outperforms the classical model",
        IN_PART,
        f"error of r: {compare(data, ked, housner).sentence('KED', 'Housner')}; relative error of the loss: "
        f"{compare(data, ked, housner, 'relative error of the loss').sentence('KED', 'Housner')}; closer in {sum(won)} "
        f"of {len(won)} rows, in {above} of {sum(slender)} above slenderness 6; against the one-liner cos^2(alpha): "
        f"{compare(data, ked, simple).sentence('KED', 'cos^2(alpha)')}",
        "errors of r over all 39 rows, and rows won",
    )


def _large_bodies() -> Claim:
    found = large_bodies([0.1, 10.0])
    flat, hollow, ked = (found[name].tolist() for name in ("flat", "hollow", "ked"))
    return Claim(
        "3.2, 4",
        "the model adapts better to large components and can be applied to them in engineering",
        UNTESTABLE,
        "the heaviest measured block is 5.6 kg; L is closer than S by a loss that does not depend on mass just "
        f"as well; a contact bed (h/b = 2, 41 points) has r = {flat[0]:.3f} at every size on a flat base, and over a "
        f"hollow of 0.1 mm {hollow[0]:.3f} at 0.1 m and {hollow[1]:.3f} at 10 m of width: what is small beside a large "
        f"body stops to matter, but the model's {ked[1]:.3f} does not become right, it is {ked[1] - flat[1]:+.3f} off",
        "no measurement of an engineering structure is in the paper; impacts resolved in time take its place",
    )


def _reality() -> Claim:
    return Claim(
        "4",
        "calculating loss and conservation stage by stage aligns more closely with reality",
        UNTESTABLE,
        "no measurement in the paper resolves the stages; stage 3 redistributes energy as no rigid body can",
        "r alone was measured; the same slender limit follows from a viscous flat contact",
    )


def _larger_structures() -> Claim:
    errors = {n: rmse(k, d.coefficient) for n, (d, _, k) in ((n, truth(n)) for n in "SML")}
    falls = {f"{one} to {other}": errors_of_groups(Ked(), one, other) for one, other in ("SM", "ML")}
    return Claim(
        "4",
        "small components have more influencing factors: the advantages are more prominent in larger structures",
        all_or_open(*falls.values()),
        ", ".join(f"{name} {error:.4f}" for name, error in errors.items())
        + f" (RMSE of r; mass S < M < L); falls {', '.join(f'from {name} by {each}' for name, each in falls.items())}",
        "RMSE by group would fall from S to M to L; bootstrap intervals of both differences",
    )


def _future() -> Claim:
    return Claim(
        "4",
        "contact time, friction at many points, three dimensions and division into units would improve the model",
        UNTESTABLE,
        "proposals for further work, built here: a contact bed, complementarity, solids in space, units; what explains "
        "the measurements stands in its own section, and it is a loss beside the bed",
        "not a statement about the measurements",
    )


JUDGES: tuple[Callable[[], Claim], ...] = (
    _outperforms,
    _large_bodies,
    _reality,
    _larger_structures,
    _future,
)
