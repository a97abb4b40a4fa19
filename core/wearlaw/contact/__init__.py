"""The contact: the problem, its solution, the theory of Hertz, materials and friction."""
