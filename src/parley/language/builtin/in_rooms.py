"""What stands in a room of the map, and all rooms: "the crates in the yard", "everything in the hall"."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.saying import with_article
from parley.language.builtin.sets import Group, group, without
from parley.language.builtin.things import head_of, link
from parley.language.lexicon import word_set
from parley.world.object_map import MapObject

__all__ = ["group_of_rooms", "inside", "room_in", "things_inside"]

_INSIDE: Final = word_set("in inside within of from")
_ALL: Final = word_set("everything all every each whole thing things object objects stuff")
"""Words by which all that is there is meant."""
_LEAVING: Final = word_set("out away off")
_ROOMS: Final = word_set("rooms room")


def group_of_rooms(
    words: Sequence[str],
    objects: Sequence[MapObject],
    rooms: Sequence[MapObject],
    lexicon: Lexicon,
    left_out: Sequence[str] = (),
) -> Group | None:
    """The set that words, in small letters, name by a room, or all rooms; None if they name none.

    Args:
        words: What was said, with what leads to it.
        objects: What the map knows.
        rooms: Its rooms, as goals.
        lexicon: Small words.
        left_out: What is named as left out of the set.
    """
    several = lexicon.classes["quantifiers"] & {*words} or "rooms" in words
    whole = tuple(room for room in rooms if room.area is None or room.area.capacity is None)  # no passages
    if several and whole and {*_bare(words, lexicon)} - _ALL <= _ROOMS and _ROOMS & {*words}:
        return _without(Group(whole), left_out, lexicon)
    room, said = room_in(words, rooms, lexicon)
    if room is None:
        return None
    held = inside(room, objects)
    if {*_bare(said, lexicon)} <= _ALL:
        if not held:
            return Group(doubt=f"My map has nothing in {with_article(room.description)}. What do you mean?")
        return _without(Group(held), left_out, lexicon)
    found = group(said, held, lexicon, left_out)
    if (found is None or found.doubt) and len(only := things_inside(words, objects, rooms, lexicon)) == 1:
        return Group(only) if "both" not in words and group(said, objects, lexicon) else found
    if found is not None:
        return found
    if group(said, objects, lexicon):  # elsewhere there are some
        what = " ".join(_bare(said, lexicon))
        return Group(doubt=f"My map has no “{what}” in {with_article(room.description)}. Which do you mean?")
    return None


def things_inside(
    words: Sequence[str], objects: Sequence[MapObject], rooms: Sequence[MapObject], lexicon: Lexicon
) -> tuple[MapObject, ...]:
    """The things that words for one of a kind in a room may mean: "the crate in the yard"."""
    room, said = room_in(words, rooms, lexicon)
    if room is None or not _bare(said, lexicon):
        return ()
    found = link(said, head_of(said, lexicon), inside(room, objects), lexicon)
    return found.things if found.kind in ("one", "several") else ()


def room_in(
    words: Sequence[str], rooms: Sequence[MapObject], lexicon: Lexicon
) -> tuple[MapObject | None, Sequence[str]]:
    """The room at the end of words, and what stands before it."""
    for at in range(1, len(words)):
        name = " ".join(word for word in words[at + 1 :] if word not in lexicon.classes["determiners"])
        room = next((one for one in rooms if one.description.lower() == name), None)
        if words[at] in _INSIDE and words[at - 1] not in _LEAVING and room is not None:
            return room, words[:at]
    return None, words


def inside(room: MapObject, objects: Sequence[MapObject]) -> tuple[MapObject, ...]:
    """The things that stand in a room."""
    return tuple(item for item in objects if room.area is not None and room.area.holds(item.x_m, item.y_m))


def _bare(words: Sequence[str], lexicon: Lexicon) -> list[str]:
    small = lexicon.classes["determiners"] | lexicon.classes["prepositions"]
    return [word for word in words if word not in small]


def _without(whole: Group, left_out: Sequence[str], lexicon: Lexicon) -> Group:
    return without(whole, left_out, lexicon) if left_out else whole
