"""Finding installed plugins, and looking up their models and data by name."""
