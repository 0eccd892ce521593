"""`rocking spectrum`: peak rotation of blocks of many sizes under motions."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rocking.answers import Answer, Display
from rocking.cli import options
from rocking.cli.compared import model_facts, overturned, show_models, with_models
from rocking.cli.exports import DATASET, Exports
from rocking.cli.numbers import row, values_table
from rocking.cli.page import Page, bar, deliver
from rocking.cli.spelling import UsageError
from rocking.messages import Amount
from rocking.spec.questions.spectrum import SpectrumQuestion, SpectrumTable

if TYPE_CHECKING:
    import xarray as xr

    from rocking.dynamics.settings import Settings


@options.takes(options.keys(SpectrumTable, "scale"), before="units")
@options.takes(
    options.keys(
        SpectrumTable,
        periods=": FIRST:LAST:COUNT, FIRST:LAST:COUNT:linear or A,B,C",
        defaults={"periods": "1:10:100"},
    ),
    before="restitution",
)
def spectrum(
    context: typer.Context,
    motions: options.SeveralRecords = None,
    motion: options.Motions = None,
    slenderness: Annotated[str, typer.Option(help="Slenderness h/b: 4,6,8 or 4:8:5; or angle: 10deg,15deg.")] = "4,6,8",
    restitution: options.Restitution = None,
    units: options.RecordUnits = None,
    sets: options.Set = None,
    friction: options.Friction = None,
    threads: options.Threads = None,
    output: Annotated[list[str] | None, options.output(DATASET)] = None,
    details: options.Details = False,
    as_json: options.AsJson = False,
) -> None:
    """Run `rocking spectrum`."""
    from rocking.cli.arguments import NO_MOTION, Arguments, hinted, is_body, is_file
    from rocking.cli.study import in_lists, problem_in, problem_of

    exports = Exports.of(output, DATASET)
    named = [*(motions or ()), *(motion or ())]
    if (problem := problem_in(context, named[0] if len(named) == 1 else None, "spectrum")) is None:
        arguments = Arguments(context, "motion", "settings", "spectrum")
        if not named:
            raise UsageError(NO_MOTION.replace("a record file", "record files"))
        angles, periods = _angles(slenderness), _periods(arguments.options["periods"])
        own = {**arguments.values(SpectrumTable), "slenderness_angles": angles, "periods": periods}
        table = arguments.table("spectrum", own, {"slenderness_angles": arguments.spelt("slenderness")})
        if body := next((word for word in named if is_body(word) and is_file(word)), None):
            raise UsageError("{file} is a body file; {reason}", file=body, reason=SpectrumQuestion.without_body)
        with hinted(None, named[0]):
            motion_tables = in_lists(arguments.each(named, arguments.one_motion))
            problem = problem_of(
                "rocking-spectrum",
                arguments,
                motion_tables,
                restitution={"model": restitution} if restitution else {},
                spectrum=table,
            )
    with bar("histories", quiet=as_json) as progress:
        dataset, others = with_models(lambda study: study.answer(progress, threads), problem)
    deliver(SpectrumAnswer(dataset, problem.settings, others, details), exports, as_json=as_json)


def _angles(text: str) -> list[float]:
    """Return slenderness angles [rad]."""
    import numpy as np

    values, unit = row("--slenderness", text, "rad")
    highest, allowed = (0.5 * math.pi, "in (0, 90) deg") if unit else (1e9, "h/b, above 0")
    bad = values[~((values > 0.0) & (values < highest))]
    if bad.size:
        raise UsageError(
            "{parameter} must be {allowed}, got {slenderness}", parameter="--slenderness", allowed=allowed,
            value=bad[0], slenderness=Amount(bad[0], "rad" if unit else ""), hint="check the unit",
        )  # fmt: skip
    angles: list[float] = (values if unit else np.arctan(1.0 / values)).tolist()
    return angles


def _periods(text: str) -> dict[str, Any]:
    """Return the periods 2 pi / p [s] as a table."""
    import numpy as np

    values, _ = row("--periods", text, "s", "log")
    if np.any(values <= 0.0) or np.any(np.diff(values) <= 0.0):
        raise UsageError(parameter="--periods", allowed="above 0 s and increase", value=text)
    return values_table("--periods", text, "s", "log")[0]


_MOST = 8  # largest number of printed curves
_SHOWN = (
    "slenderness_ratio", "slenderness_angle", "not_lifted", "rocked", "overturned", "largest_peak_ratio",
    "largest_overturned_period",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class SpectrumAnswer:
    """Spectra of `rocking_spectrum`."""

    dataset: "xr.Dataset"
    settings: "Settings"
    others: dict[str, Any]  # spectra of the compared models
    details: bool = False

    def draw(self) -> Any:
        from rocking.plots.rocking_spectrum import rocking_spectrum_picture

        return rocking_spectrum_picture(self.dataset)

    def answer(self) -> Answer:
        """Return every history, and the summary of each curve."""
        dataset = self.dataset
        return Answer({
            "motions": [str(name) for name in dataset["motion"].values.tolist()],
            "restitution": dataset.attrs["restitution"],
            "scale": float(dataset.attrs["scale"]),
            "linear": bool(dataset.attrs["setting_linear"]),
            "gravity": float(dataset.attrs["setting_gravity"]),
            "slenderness_angle": dataset["slenderness_angle"].values,
            "period": dataset["period"].values,
            "semi_diagonal": dataset["semi_diagonal"].values,
            "mode": dataset["mode"].values,
            "peak_ratio": dataset["peak_ratio"].values,
            "curves": self.curves(),
            "contact": dataset.attrs["contact"],
            **model_facts(dataset.attrs["restitution"], self.others, _overturned),
        })  # fmt: skip

    def curves(self) -> list[dict[str, Any]]:
        """Return one summary per curve: numbers of blocks by outcome, largest peak ratio, largest overturned period."""
        return [
            {
                "motion": str(name),
                "slenderness_angle": alpha,
                "slenderness_ratio": 1.0 / math.tan(alpha),
                **_curve(self.dataset.isel(motion=i, slenderness_angle=j)),
            }
            for i, name in enumerate(self.dataset["motion"].values.tolist())
            for j, alpha in enumerate(self.dataset["slenderness_angle"].values.tolist())
        ]

    def show(self, page: Page) -> None:
        from rocking.cli.study import contact_lines

        dataset, curves = self.dataset, self.curves()
        periods, sizes = dataset["period"].values, dataset["semi_diagonal"].values
        page.line(
            f"Blocks: 2 pi / p {periods[0]:.4g} to {periods[-1]:.4g} s, R {sizes[0]:.4g} to {sizes[-1]:.4g} m, "
            f"{periods.size} sizes"
        )
        page.facts(contact_lines(self.settings))
        page.line(f"Restitution: {dataset.attrs['restitution']}")
        page.line()
        count = _overturned(dataset)["overturned"]
        page.line(f"Overturning in {count} of {dataset['mode'].size} histories.", "bold")
        per_motion = dataset.sizes["slenderness_angle"]
        count = len(curves) if self.details else max(_MOST // per_motion, 1) * per_motion
        for first in range(0, min(count, len(curves)), per_motion):
            page.line(f"\n{curves[first]['motion']}", "bold")
            page.rows(curves[first : first + per_motion], _SHOWN, most=per_motion)
        if len(curves) > count:
            page.line(f"... and {(len(curves) - count) // per_motion} more motions: --details")
        page.line(
            "\npeak / alpha: largest value without overturning. overturns up to: largest 2 pi / p with overturning."
        )
        failed = sum(curve["failed"] for curve in curves)
        page.warn([f"{failed} histories could not be computed"] if failed else [])
        page.warn(filter(None, [dataset.attrs["contact"]]))
        show_models(page, self.answer(), Display(), dataset.attrs["restitution"], _overturned(dataset))
        if not self.details:
            page.line("All motions: --details    Files: -o spectrum.csv, -o spectrum.png")


def _overturned(dataset: "xr.Dataset") -> dict[str, Any]:
    return overturned(dataset["mode"].values)


def _curve(histories: "xr.Dataset") -> dict[str, Any]:
    mode, period = histories["mode"].values, histories["period"].values
    peaks, overturned_periods = histories["peak_ratio"].values[(mode == -1) | (mode == -2)], period[mode >= 0]
    return {
        "not_lifted": int((mode == -2).sum()),
        "rocked": int((mode == -1).sum()),
        "overturned": int((mode >= 0).sum()),
        "failed": int((mode == -3).sum()),
        "largest_peak_ratio": float(peaks.max()) if peaks.size else None,
        "largest_overturned_period": float(overturned_periods.max()) if overturned_periods.size else None,
    }
