"""A plane body that rocks about its feet with tendons, dampers, fuses, springs and walls."""
