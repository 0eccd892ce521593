"""Histories that take as long as a test wants: motions that take long to make, and costs that change on the way."""

import os
import time

import numpy as np

import rocking as rk
from rocking.studies import HistoryTable, MotionSet, Product


class Motions(MotionSet):
    """Pulses that take a while to make, and are noted in a folder with the process that made them."""

    def __init__(self, count, seconds, folder, spend=time.sleep):
        self.count, self.seconds, self.folder, self.spend = count, seconds, folder, spend

    def __len__(self):
        return self.count

    def __getitem__(self, index):
        self.spend(self.seconds)
        with (self.folder / f"made-{os.getpid()}").open("a") as file:
            file.write(f"{index}\n")
        return rk.pulses.sine(2.0 + 6.0 * (index % 17) / 17.0, 0.4 + 0.8 * (index % 13) / 13.0)

    def description(self):
        return {"kind": "slow", "count": self.count}

    def made(self):
        """Numbers of the motions that were made, by whomever."""
        return [int(line) for path in sorted(self.folder.glob("made-*")) for line in path.read_text().split()]


def product(motions, each=12):
    """Some histories of every motion."""
    angle = np.array([[0.2], [0.3]])
    sides = {f"alpha_{side}": angle for side in ("right", "left")} | {"r_right": 0.0 * angle + 0.9}
    sides |= {f"p_{side}": 8.0 * angle for side in ("right", "left")} | {"r_left": 0.0 * angle + 0.85}
    return Product(motions, sides, np.linspace(0.5, 4.0, each // 2))


class Costly(HistoryTable):
    """Histories whose cost depends on their number, and is slept."""

    def cost(self, share):
        """Return what each costs [s], by its place from nought to one."""
        return np.asarray(self.__dict__["costs"](share))

    def run(self, first, last, *, threads=None):
        self.__dict__["spend"](float(self.cost((np.arange(first, last) + 0.5) / self.count).sum()))
        return super().run(first, last, threads=threads)


def costly(table, costs, spend=time.sleep):
    """Give histories a cost."""
    made = Costly(table.motions, table.motion, table.values, law=table.law)
    object.__setattr__(made, "costs", costs)
    object.__setattr__(made, "spend", spend)
    return made
