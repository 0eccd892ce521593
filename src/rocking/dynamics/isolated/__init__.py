"""A plane body on a base that is isolated from the ground: linear isolators, rollers, or Coulomb friction."""
