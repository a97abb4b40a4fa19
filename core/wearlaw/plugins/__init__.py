"""Finding installed plugins, and looking up by name what they provide."""
