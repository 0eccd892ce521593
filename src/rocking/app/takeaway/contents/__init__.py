"""What stands in the tables: body, coefficients, motion, spectrum, measures, response, impacts."""
