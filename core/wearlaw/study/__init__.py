"""Case files, and running the studies that they describe."""
