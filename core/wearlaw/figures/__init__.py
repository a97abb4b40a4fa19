"""The contents of figures, and drawing them for print."""
