"""Studies as campaigns of the web application: launched, watched, cancelled, resumed, looked at and taken away."""

GRACE = 0.4  # time that a study has between the wish to stop and its end [s]
