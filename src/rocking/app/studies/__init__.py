"""Studies as campaigns of the web application: launched, watched, cancelled, resumed, looked at and taken away."""
