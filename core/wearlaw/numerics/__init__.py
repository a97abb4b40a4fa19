"""Solving contacts block by block, and the mean of a wear law over the patch."""
