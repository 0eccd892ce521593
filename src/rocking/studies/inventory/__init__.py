"""Inventories: which objects of a list stay standing at a level of shaking, in a ranked table and plain words."""

from rocking.studies.inventory.assessment import assess
from rocking.studies.inventory.hazard import Hazard, Level
from rocking.studies.inventory.lights import Light, Thresholds, share_interval
from rocking.studies.inventory.objects import InventoryObject, NotAssessed
from rocking.studies.inventory.reading import Inventory, parse_inventory, read_inventory
from rocking.studies.inventory.verdict import Assessment, DirectionResult, Verdict

__all__ = [
    "Assessment",
    "DirectionResult",
    "Hazard",
    "Inventory",
    "InventoryObject",
    "Level",
    "Light",
    "NotAssessed",
    "Thresholds",
    "Verdict",
    "assess",
    "parse_inventory",
    "read_inventory",
    "share_interval",
]
