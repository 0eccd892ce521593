"""Claims of section 3.1 of the paper: values, tables and Figures 3 and 5."""

from collections.abc import Callable

import numpy as np

from rocking.evidence._errata import closer_rows
from rocking.evidence.agreement import correlation, loss_rmse, rmse
from rocking.evidence.claim import FAILS, HOLDS, IN_PART, Claim, all_or_open, resolved, truth, verdict_of
from rocking.evidence.comparison import compare, errors_of_groups
from rocking.evidence.measurements import blocks, datasets
from rocking.evidence.tables import recomputed
from rocking.restitution import Ked


def _closer(section: str, quote: str, names: tuple[str, ...]) -> Claim:
    won = [closer for name in names for closer in closer_rows(datasets()[name])]
    joined = [truth(name) for name in names]
    measured = np.concatenate([data.coefficient for data, _, _ in joined])
    housner, ked = (np.concatenate([parts[i] for parts in joined]) for i in (1, 2))
    found = compare(datasets()[names[0]] if len(names) == 1 else blocks(), ked, housner)
    closer_by_rows = sum(won) > 0.75 * len(won)
    return Claim(
        section,
        quote,
        IN_PART if found.sign < 0 and not closer_by_rows else resolved(-found.sign),
        f"closer in {sum(won)} of {len(won)} rows; RMSE of r {rmse(ked, measured):.4f} against "
        f"{rmse(housner, measured):.4f}; of the energy loss {loss_rmse(ked, measured):.4f} against "
        f"{loss_rmse(housner, measured):.4f}; {found.sentence('KED', 'Housner')}",
        "paired bootstrap of the errors over all rows; in part where KED is closer in less than three rows of four",
    )


def _above_classical() -> Claim:
    data, housner, _ = truth("table1")
    above = int((data.coefficient > housner).sum())
    return Claim(
        "3.1",
        "all experimental values (Table 1) are higher than those of the classical model",
        verdict_of(above == len(data)),
        f"{above} of {len(data)} rows; smallest excess {float((data.coefficient - housner).min()):.4f}",
        "measured r against Housner's true r, row by row",
    )


def _materials_negligible() -> Claim:
    data, *_ = truth("table1")
    spans = {ratio: float(np.ptp(data.coefficient[data.slenderness == ratio])) for ratio in (2.0, 4.0)}
    return Claim(
        "3.1",
        "the error introduced by different materials is considered negligible",
        FAILS,
        f"at equal slenderness the measured r differ by {spans[2.0]:.3f} (h/b = 2) and {spans[4.0]:.3f} (h/b = 4); "
        "rounding explains 0.006",
        "range of the measured r of different interfaces at the same slenderness, against the rounding",
    )


def _table_2_values() -> Claim:
    rows = recomputed("table2")
    agree = sum(row.entries["ked"].agrees for row in rows)
    return Claim(
        "3.1",
        "the program of Appendix A gives the r_r of Table 2",
        verdict_of(agree == len(rows)),
        f"{agree} of {len(rows)} agree in all 8 printed digits",
        "Eq. 17 in closed form",
    )


def _closer_table_2() -> Claim:
    return _closer("3.1", "Table 2: r_r aligns more closely with the experimental values", ("table2",))


def _error_bars() -> Claim:
    data, housner, ked = truth("table2")
    inside = np.abs(housner - data.coefficient) <= np.abs(ked - data.coefficient)
    found = data.slenderness[inside].tolist()
    return Claim(
        "3.1",
        "Housner's curve falls within the error bars of Figure 3 only at slenderness 3 and 8.33",
        verdict_of(found == [3.0, 8.33]),
        f"inside at {', '.join(f'{ratio:g}' for ratio in found)}",
        "|r_H - r_e| <= |r_r - r_e| with the true r_H",
    )


def _ten_blocks() -> Claim:
    counts = [len(datasets()[name]) for name in ("S", "M", "L")]
    return Claim(
        "3.1",
        "each set contained 10 blocks with different slenderness",
        FAILS,
        f"Table 3 lists {counts[0]}, {counts[1]} and {counts[2]}",
        "rows of Table 3",
    )


def _table_3_values() -> Claim:
    entries = [row.entries for name in ("S", "M", "L") for row in recomputed(name)]
    ked = sum(entry["ked"].agrees for entry in entries)
    housner = sum(entry["housner"].agrees for entry in entries)
    return Claim(
        "3.1",
        "r_H and r_r of Table 3 were calculated from both models",
        verdict_of(ked == housner == len(entries)),
        f"r_r: {ked}, r_H: {housner} of {len(entries)} agree in all 3 printed digits",
        "both models in closed form",
    )


def _closer_table_3() -> Claim:
    return _closer("3.1", "Table 3: r_r is in better agreement with the experimental values", ("S", "M", "L"))


def _group_l_closer() -> Claim:
    errors = {name: rmse(ked, data.coefficient) for name, (data, _, ked) in ((n, truth(n)) for n in "SML")}
    more = {name: errors_of_groups(Ked(), name, "L") for name in "SM"}
    return Claim(
        "3.1",
        "Figure 5: the blocks of group L are closest to KED",
        all_or_open(*more.values()),
        ", ".join(f"{name} {error:.4f}" for name, error in errors.items())
        + "".join(f"; {name} above L by {each}" for name, each in more.items()),
        "RMSE of r by group; differences between groups with their bootstrap intervals",
    )


def _stable_deviation() -> Claim:
    spread = {}
    for name in "SML":
        data, _, ked = truth(name)
        spread[name] = float(np.std(ked - data.coefficient, ddof=1)), float(np.mean(ked - data.coefficient))
    stable = all(sd < 0.5 * abs(mean) for sd, mean in spread.values())
    return Claim(
        "3.1",
        "the experimental data deviate from KED by a relatively stable amount",
        HOLDS if stable else IN_PART,
        "mean and standard deviation of r_r - r_e: "
        + ", ".join(f"{name} {mean:+.4f}, {sd:.4f}" for name, (sd, mean) in spread.items()),
        "the scatter of the deviation is below half its mean in every group; in part if not",
    )


def _housner_worse_when_squat() -> Claim:
    parts = [truth(name) for name in "SML"]
    steps = np.concatenate([np.diff((d.coefficient - h)[d.slenderness <= 6.0]) for d, h, _ in parts])
    falling = int((steps < 0.0).sum())
    trends = [correlation(data.slenderness, np.abs(data.coefficient - housner)) for data, housner, _ in parts]
    return Claim(
        "3.1",
        "the deviation from the classical model grows as the slenderness decreases",
        HOLDS if falling == steps.size else IN_PART if falling > 0.7 * steps.size else FAILS,
        f"r_e - r_H falls in {falling} of {steps.size} steps up to slenderness 6; correlation of its size with h/b in "
        f"S, M, L {', '.join(f'{value:.2f}' for value in trends)}",
        "sign of every step of r_e - r_H up to slenderness 6; in part above 70 %",
    )


JUDGES: tuple[Callable[[], Claim], ...] = (
    _above_classical,
    _materials_negligible,
    _table_2_values,
    _closer_table_2,
    _error_bars,
    _ten_blocks,
    _table_3_values,
    _closer_table_3,
    _group_l_closer,
    _stable_deviation,
    _housner_worse_when_squat,
)
