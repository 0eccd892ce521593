"""Inventories: rate the objects of a list at an intensity level; a ranked table with sentences."""

from rocking.studies.inventory._inventory import inventory
from rocking.studies.inventory.assessment import assess
from rocking.studies.inventory.lights import Thresholds
from rocking.studies.inventory.objects import InventoryObject
from rocking.studies.inventory.reading import Inventory, parse_inventory, read_inventory

__all__ = [
    "Inventory",
    "InventoryObject",
    "Thresholds",
    "assess",
    "inventory",
    "parse_inventory",
    "read_inventory",
]
