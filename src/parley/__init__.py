"""Parley: run robots by talking to them."""

__all__ = ["__version__"]

__version__ = "0.1.0"
