"""A small terminal emulator: turns what a program writes into what a person sees."""

from __future__ import annotations

import re

__all__ = ["Screen"]

_TOKEN = re.compile(r"\x1b\[(?P<args>[0-9;?]*)(?P<final>[A-Za-z])|\x1b[()=>].?|(?P<char>[^\x1b])", re.DOTALL)
_INCOMPLETE = re.compile(r"\x1b(\[[0-9;?]*)?$")


class Screen:
    """Knows the sequences that move the cursor and erase. It never scrolls: rows are kept."""

    def __init__(self, columns: int) -> None:
        self.columns = columns
        self.rows: list[list[str]] = [[]]
        self.row = self.column = 0
        self._rest = ""

    @property
    def text(self) -> str:
        """All rows, without blanks at their ends."""
        return "\n".join("".join(row).rstrip() for row in self.rows)

    def feed(self, data: str) -> list[str]:
        """Take what the program wrote; returns what the terminal answers to its questions."""
        answers: list[str] = []
        data = self._rest + data
        incomplete = _INCOMPLETE.search(data)
        self._rest = incomplete.group() if incomplete else ""
        for token in _TOKEN.finditer(data[: len(data) - len(self._rest)]):
            if token["char"]:
                self._write(token["char"])
            elif token["final"] == "n":
                answers.append(f"\x1b[{self.row + 1};{self.column + 1}R")
            elif token["final"] and not token["args"].startswith("?"):
                self._obey(token["final"], int(token["args"].split(";")[0] or 0))
        return answers

    def _write(self, char: str) -> None:
        if char == "\n":
            self._move_to(self.row + 1, self.column)
        elif char == "\r":
            self.column = 0
        elif char == "\b":
            self.column = max(0, self.column - 1)
        elif char >= " ":
            if self.column == self.columns:
                self._move_to(self.row + 1, 0)
            row = self.rows[self.row]
            row.extend(" " * (self.column + 1 - len(row)))
            row[self.column] = char
            self.column += 1

    def _obey(self, final: str, number: int) -> None:
        steps = max(1, number)
        if final == "A":
            self.row = max(0, self.row - steps)
        elif final == "B":
            self._move_to(self.row + steps, self.column)
        elif final == "C":
            self.column = min(self.columns - 1, self.column + steps)
        elif final == "D":
            self.column = max(0, self.column - steps)
        elif final == "K":
            del self.rows[self.row][self.column :]
        elif final == "J":
            del self.rows[self.row][self.column :]
            del self.rows[self.row + 1 :]

    def _move_to(self, row: int, column: int) -> None:
        self.row, self.column = row, column
        while len(self.rows) <= row:
            self.rows.append([])
