"""Sweeps of many operating points, on processes or a cluster, kept on disk."""
