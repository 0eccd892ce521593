"""A plane body that rocks about its feet without sliding or flying."""
