"""Of what a body in space consists: the solid that its mass, centre and inertia came from."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from rocking.bodies.solid import Part, Solid, box, cylinder
from rocking.conventions import FloatArray


@dataclass(frozen=True, eq=False)
class Matter:
    """A solid and where it is in the axes of a body, made when somebody asks.

    Most models of an impact need mass, centre and inertia alone; those that need every mass point ask for this.
    """

    make: Callable[[], Solid]  # returns the solid
    shift: FloatArray  # origin of the body's axes in the coordinates in which the solid is described [m]; shape (3,)

    @cached_property
    def placed(self) -> tuple[Solid, FloatArray]:
        """The solid, and the origin of its own frame in axes of the body [m]."""
        solid = self.make()
        return solid, solid.origin - self.shift

    def __call__(self) -> tuple[Solid, FloatArray]:
        """Return `placed`, as impacts ask for it.

        Returns origin: origin of its own frame in axes of the body [m] (shape (3,)).
        """
        return self.placed

    @classmethod
    def of_box(cls, width: float, depth: float, height: float, density: float) -> "Matter":
        """Return the matter of a box whose base is centred over the origin.

        width, depth, height: full sizes along x, y and z [m]; density: density [kg/m3].
        """
        return cls(partial(_box, width, depth, height, density), np.zeros(3))

    @classmethod
    def of_cylinder(cls, diameter: float, height: float, density: float) -> "Matter":
        """Return the matter of a cylinder whose base is centred over the origin.

        diameter, height: full sizes [m]; density: density [kg/m3].
        """
        return cls(partial(_cylinder, diameter, height, density), np.zeros(3))

    @classmethod
    def of_solid(cls, solid: Solid, shift: FloatArray) -> "Matter":
        """Return the matter of a solid.

        shift: origin of the body's axes in the coordinates of the solid [m].
        """
        return cls(partial(_same, solid), shift)


# functions of the module, so that a body can be sent to another process
def _box(width: float, depth: float, height: float, density: float) -> Solid:
    return Solid(Part(box(width, depth, height), density))


def _cylinder(diameter: float, height: float, density: float) -> Solid:
    return Solid(Part(cylinder(diameter, height), density))


def _same(solid: Solid) -> Solid:
    return solid
