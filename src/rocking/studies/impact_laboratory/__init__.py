"""The impact laboratory: what the coefficient of restitution of a contact bed depends on."""
