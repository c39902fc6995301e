"""A search of several rooms as several searches: "look for the crate in the hall and the yard"."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from parley.world.object_map import MapObject

__all__ = ["searched_apart"]

_SEEKING: Final = r"(?:look|search|hunt)(?: around)? for|try to find|find"
_WHAT: Final = r"(?P<what>(?:(?!(?:in|at|on|near|and|then)\b)[\w'’-]+ ?){1,6}?)"
_LEADING: Final = r"(?:in|at|near|by|on|under|behind)"


def searched_apart(text: str, places: Sequence[MapObject], rooms: Sequence[MapObject]) -> str:
    """A text in which what is sought in several places of the map, some of them rooms, is sought in each."""
    names = sorted(
        {re.escape(name) for place in places for name in (place.description, *place.aliases)},
        key=len,
        reverse=True,
    )
    if not names or re.search(r"\b(?:look|search|hunt|find)\b", text, re.IGNORECASE) is None:
        return text
    one = rf"(?:the |my |our )?(?:{'|'.join(names)})"
    more = rf"(?:(?:,| and|, and)(?: also)? (?:{_LEADING} )?{one})+"
    listed = re.compile(
        rf"\b(?:{_SEEKING}) {_WHAT} ?(?P<led>{_LEADING}) (?P<where>{one}{more})(?![\w-])|"
        rf"\b(?:search|look (?:in|through)) (?P<all>{one}{more}) for "
        r"(?P<sought>(?:[\w'’-]+ ?){1,5}?)(?=\W*$|[,.;])",
        re.IGNORECASE,
    )
    each = re.compile(one, re.IGNORECASE)

    def apart(found: re.Match[str]) -> str:
        what = (found["what"] or found["sought"]).strip()
        where = each.findall(found["where"] or found["all"])
        if not any(place.lower().endswith(room.description.lower()) for place in where for room in rooms):
            return found[0]
        return ", then ".join(f"look for {what} {found['led'] or 'in'} {place}" for place in where)

    return listed.sub(apart, text)
