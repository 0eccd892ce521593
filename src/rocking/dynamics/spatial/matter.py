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

    Parameters
    ----------
    make : callable
        Returns the solid.
    shift : ndarray, shape (3,)
        Origin of the body's axes in the coordinates in which the solid is described [m].
    """

    make: Callable[[], Solid]
    shift: FloatArray

    @cached_property
    def placed(self) -> tuple[Solid, FloatArray]:
        """The solid, and the origin of its own frame in axes of the body [m]."""
        solid = self.make()
        return solid, solid.origin - self.shift

    def __call__(self) -> tuple[Solid, FloatArray]:
        """Return `placed`, as impacts ask for it.

        Returns
        -------
        solid : Solid
            The solid.
        origin : ndarray, shape (3,)
            Origin of its own frame in axes of the body [m].
        """
        return self.placed

    @classmethod
    def of_box(cls, width: float, depth: float, height: float, density: float) -> "Matter":
        """Return the matter of a box whose base is centred over the origin.

        Parameters
        ----------
        width, depth, height : float
            Full sizes along x, y and z [m].
        density : float
            Density [kg/m3].

        Returns
        -------
        Matter
            Of the box.
        """
        return cls(partial(_box, width, depth, height, density), np.zeros(3))

    @classmethod
    def of_cylinder(cls, diameter: float, height: float, density: float) -> "Matter":
        """Return the matter of a cylinder whose base is centred over the origin.

        Parameters
        ----------
        diameter, height : float
            Full sizes [m].
        density : float
            Density [kg/m3].

        Returns
        -------
        Matter
            Of the cylinder.
        """
        return cls(partial(_cylinder, diameter, height, density), np.zeros(3))

    @classmethod
    def of_solid(cls, solid: Solid, shift: FloatArray) -> "Matter":
        """Return the matter of a solid.

        Parameters
        ----------
        solid : Solid
            The solid.
        shift : ndarray, shape (3,)
            Origin of the body's axes in the coordinates of the solid [m].

        Returns
        -------
        Matter
            The solid itself.
        """
        return cls(partial(_same, solid), shift)


# functions of the module, so that a body can be sent to another process
def _box(width: float, depth: float, height: float, density: float) -> Solid:
    return Solid(Part(box(width, depth, height), density))


def _cylinder(diameter: float, height: float, density: float) -> Solid:
    return Solid(Part(cylinder(diameter, height), density))


def _same(solid: Solid) -> Solid:
    return solid
