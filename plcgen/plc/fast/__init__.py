"""The compiled engine: core programs as code of a small virtual machine that Numba compiles once."""
