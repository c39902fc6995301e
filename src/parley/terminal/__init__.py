"""The operator's terminal: a client of the conversation over any transport."""

from parley.terminal.client import TerminalClient

__all__ = ["TerminalClient"]
