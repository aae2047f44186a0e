"""Jerk-limited motion source for Siemens PLCs, executed and verified before it is written."""

__version__ = "0.1.0"
