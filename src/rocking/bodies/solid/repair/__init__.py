"""Repair of the surface of a mesh or of a point cloud: one step per file, each with its entry in the log of repairs.

`steps.py` has the order of the steps. A step takes points, faces and the log, and returns points and faces.
"""
