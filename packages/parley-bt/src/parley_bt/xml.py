"""Reading XML from strangers: bounded, without entities, and with the line of every element."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final
from xml.parsers import expat

from parley.errors import GraphRefusedError
from parley_bt.reasons import refusal

__all__ = ["Element", "parse"]

MAX_CHARACTERS: Final = 1_000_000
MAX_DEPTH: Final = 100
MAX_ELEMENTS: Final = 20_000


@dataclass(slots=True)
class Element:
    """One XML element; text between elements says nothing in this format."""

    tag: str
    attributes: dict[str, str]
    line: int
    children: list[Element] = field(default_factory=list)

    @property
    def path(self) -> str:
        """Where it stands, for messages."""
        return f"line {self.line}, <{self.tag}>"

    def all(self, tag: str) -> Iterator[Element]:
        """The children of that tag."""
        return (child for child in self.children if child.tag == tag)


def parse(text: str) -> Element:
    """The root element.

    Raises:
        GraphRefusedError: It is not XML, has a document type, or is too large.
    """
    if len(text) > MAX_CHARACTERS:
        raise GraphRefusedError("", [refusal("too_large", "")])
    building = _Building()
    try:
        building.parser.Parse(text.encode("utf-8"), True)
    except expat.ExpatError as error:
        what = expat.ErrorString(error.code)
        raise GraphRefusedError("", [refusal("malformed_xml", f"line {error.lineno}", what)]) from error
    except UnicodeEncodeError as error:
        raise GraphRefusedError("", [refusal("malformed_xml", "", "half a character")]) from error
    return building.root


class _Building:
    """The tree while it is read."""

    def __init__(self) -> None:
        self.root = Element("", {}, 0)
        self._open: list[Element] = []
        self._count = 0
        self.parser = expat.ParserCreate("utf-8")
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = lambda _: self._open.pop()
        # Without a document type there are no entities to expand, so the first sight of one is the end.
        self.parser.StartDoctypeDeclHandler = self._doctype

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        element = Element(tag, attributes, self.parser.CurrentLineNumber)
        self._count += 1
        if len(self._open) >= MAX_DEPTH or self._count > MAX_ELEMENTS:
            raise GraphRefusedError("", [refusal("too_large", element.path)])
        if self._open:
            self._open[-1].children.append(element)
        else:
            self.root = element
        self._open.append(element)

    def _doctype(self, name: str, *_: object) -> None:
        raise GraphRefusedError("", [refusal("doctype", f"line {self.parser.CurrentLineNumber}", name)])
