"""Sliding and hopping: the compiled engine against the reference engine, in CPU time on one core, in one run.

``python -m benchmarks.contact``: bodies that slide, rock or mostly rest under records of 29,000 samples.
"""

import statistics
import time

import numpy as np

import rocking as rk

SAMPLES, STEP, COPIES = 29_000, 0.005, 24


def records() -> dict[str, rk.GroundMotion]:
    """Made-up records: one that shakes throughout, one that is quiet but for a burst of 10 s."""
    rng, t = np.random.default_rng(1), np.arange(SAMPLES) * STEP
    noise = np.convolve(rng.standard_normal(SAMPLES), np.ones(20) / 20**0.5, "same")
    throughout = 3.0 * np.sin(6.0 * t) * np.exp(-(((t - 70.0) / 25.0) ** 2)) + 0.6 * noise
    burst = 4.0 * np.sin(5.0 * t) * np.exp(-(((t - 20.0) / 5.0) ** 2)) + 0.1 * noise
    return {"throughout": rk.GroundMotion(throughout, STEP), "a burst": rk.GroundMotion(burst, STEP)}


def main() -> None:
    """Print the seconds of a history and their ratio, case by case, and the median ratio."""
    for engine in ("fast", "reference"):  # imports are nobody's speed
        rk.simulate_many(rk.Block(width=1.0, height=2.0), rk.pulses.sine(4.0, 0.5), 0.9, friction=0.5, engine=engine)
    ratios = []
    for name, motion in records().items():
        for mu in (0.2, 0.5, 1.0):
            for body in (rk.Block(width=0.8, height=2.4), rk.Block(width=1.4, height=2.0)):
                seconds = {}
                for engine, count in (("fast", COPIES), ("reference", 1)):
                    scales = np.linspace(1.0, 1.0 + 1e-6, count)
                    began = time.process_time()
                    dataset = rk.simulate_many(
                        body,
                        motion,
                        0.9,
                        friction=mu,
                        scale=scales,
                        engine=engine,
                        threads=1 if engine == "fast" else None,
                    )
                    seconds[engine] = (time.process_time() - began) / count
                ratios.append(seconds["reference"] / seconds["fast"])
                outcome = rk.Outcome.__members__.values()
                word = list(outcome)[int(dataset["outcome"].values.flat[0])].name.lower()
                print(
                    f"{name:12} mu {mu:.1f} width {body.width:.1f}  {1e3 * seconds['fast']:8.3f} ms  "
                    f"{seconds['reference']:6.2f} s  {ratios[-1]:6.0f} times  {word}"
                )
    print(f"median {statistics.median(ratios):.0f} times on one core")


if __name__ == "__main__":
    main()
