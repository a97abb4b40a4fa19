"""Pipelines of rig | contact model | wear law, their predictions and their warnings."""
