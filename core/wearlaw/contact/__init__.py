"""The contact: the problem, its solution, the theories of Hertz and Kalker, materials and friction."""
