"""Arrays of SI values: their type, their extremes, and loops over them that numba compiles."""
