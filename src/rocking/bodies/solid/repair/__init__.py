"""Repair of the surface of a mesh or of a point cloud: one step per file.

A function per step takes points, faces and the log of repairs, and returns points and faces. `steps.py` defines the
order of the steps.
"""
