"""Long-run dynamics of rocking under harmonic ground motion: orbits, bifurcations, exponents, basins, thresholds."""
