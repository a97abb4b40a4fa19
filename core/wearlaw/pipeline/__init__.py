"""What a user composes: rig | contact model | wear law, its predictions, and what it warns of."""
