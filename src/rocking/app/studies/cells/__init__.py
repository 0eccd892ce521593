"""The history behind a point of a picture: what was computed there, as inputs that anybody can go on with."""
