"""A plane body that rocks about its feet and does not slide or fly."""
