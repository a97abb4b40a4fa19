"""Sweeps: many operating points, in blocks, on several processes or a cluster, kept on disk as they go."""
