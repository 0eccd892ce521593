"""Inventories: which objects of a list stay standing at a level of shaking, in a ranked table and plain words."""

from rocking.studies.inventory.assessment import Assessment, DirectionResult, Verdict, assess
from rocking.studies.inventory.hazard import Hazard, IntensityLevel
from rocking.studies.inventory.lights import Light, Thresholds, share_interval
from rocking.studies.inventory.objects import InventoryObject, NotAssessed
from rocking.studies.inventory.reading import Inventory, parse_inventory, read_inventory

__all__ = [
    "Assessment",
    "DirectionResult",
    "Hazard",
    "IntensityLevel",
    "Inventory",
    "InventoryObject",
    "Light",
    "NotAssessed",
    "Thresholds",
    "Verdict",
    "assess",
    "parse_inventory",
    "read_inventory",
    "share_interval",
]
