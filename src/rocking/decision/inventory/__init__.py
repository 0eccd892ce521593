"""Inventories: rate the objects of a list at an intensity level; a ranked table with sentences."""

from rocking.decision.inventory._inventory import inventory
from rocking.decision.inventory.assessment import assess
from rocking.decision.inventory.lights import Thresholds
from rocking.decision.inventory.lists.reader import Inventory, parse_inventory, read_inventory
from rocking.decision.inventory.objects import InventoryObject

__all__ = [
    "Inventory",
    "InventoryObject",
    "Thresholds",
    "assess",
    "inventory",
    "parse_inventory",
    "read_inventory",
]
