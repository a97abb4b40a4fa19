"""Writing results into folders."""
