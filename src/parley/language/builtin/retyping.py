"""Frames that differ by their roles alone: taking to a place is bringing, turning to a thing is facing it."""

from __future__ import annotations

from dataclasses import replace

from parley.language.builtin.amounts import amount_of, direction_of, is_compass
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.spans import Filler
from parley.language.builtin.wishes import Wish

__all__ = ["BACKING", "PLACING", "looks_here", "retyped"]

BACKING = frozenset({"back", "backup", "reverse", "backing", "reversing", "retreat"})
"""Verbs that say the direction themselves."""
_HEREABOUTS = frozenset({"around", "round", "here"})
_LOOKED_ON = frozenset({"on", "in", "inside", "at", "around", "round", "through", "over"})
_HITHER = frozenset({"back", "here", "to", "over"})
PLACING = frozenset({"on", "in", "at", "near", "by", "under", "beside", "next", "behind", "inside"})
"""Prepositions that say where something is, and not where to."""
_AT = PLACING | {"from", "off"}
_TOLD_OF = frozenset({"what", "which", "who", "how", "where", "if", "whether"})
_QUESTION = frozenset({"question", "questions"})
_NUMBERS = frozenset({("number", "of"), ("amount", "of")})
_BEING = frozenset({"that", "who", "which", "is", "are", "there", "'s", "do", "does", "you", "see"})
_JOINED = 2
"""So many marks and words at most stand between what is listed: ", and"."""
_FROM_THERE = frozenset({"from", "there", "here", "on"})
_POINTING = frozenset({"to", "it", "there", "that", "one"})
_SUCH = frozenset({"for", "a", "an", "that", "who", "which"})
_HERE = frozenset({"here", "there", "where", "you", "are"})
_TAKING = frozenset({"take", "grab", "pick", "collect", "lift"})


def retyped(wish: Wish, lexicon: Lexicon) -> Wish:
    """With the frame that its roles ask for."""
    if wish.frame in ("GO", "TURN"):
        wish = _renamed(wish, "G", "H", [f for f in wish.all("G") if _is_direction(f, lexicon)])
    wish = _searched(wish)
    if wish.frame in ("SAY", "LOOK", "COUNT"):
        return _seen(wish) if wish.has("K") else _looked_at(wish)
    if wish.frame in ("FIND", "GIVE", "BRING"):
        wish = _met(wish, lexicon)
    if wish.frame == "ANSWER":
        return replace(wish, fillers=tuple(one for f in wish.fillers for one in _asked_by(f, lexicon)))
    if wish.frame == "WAIT" and not wish.has("DU") and any({*f.words} - _HERE for f in wish.all("L")):
        return replace(_renamed(wish, "L", "G", list(wish.all("L"))), frame="GO")  # "stop at the gate"
    if wish.frame == "FOLLOW" and not wish.has("T"):  # "trail behind Kim"
        behind = [f for f in wish.all("L") if f.words[0] in _AFTER and len(f.words) > 1]
        rest = tuple(f for f in wish.fillers if f not in behind)
        return replace(wish, fillers=(*rest, *(_without_first(f) for f in behind)))
    if wish.frame == "GUIDE" and not wish.has("T"):
        return _renamed(wish, "R", "T", list(wish.all("R")))
    if wish.frame == "GO":
        return _to_where(wish)
    if wish.frame == "TURN" and not wish.has("N"):
        direction = next((direction_of(filler.words, lexicon) for filler in wish.all("H")), None)
        return replace(wish, frame="FACE") if wish.has("TG") or is_compass(direction or "") else wish
    if wish.frame == "TAKE":
        wish = _renamed(wish, "G", "S", [f for f in wish.all("G") if f.words[0] in _AT])
        return replace(wish, frame="BRING") if wish.has("RG") and wish.has("T") else wish
    if wish.frame == "BRING" and not wish.has("RG") and wish.verb.split(" ")[0] in _TAKING:
        return replace(wish, frame="TAKE")
    return wish


def _searched(wish: Wish) -> Wish:
    """A look at several things, or for something: "check the bay, then the ramp", "search it for crates"."""
    if wish.frame == "GO" and wish.verb == "search" and wish.has("K"):
        wish = replace(wish, frame="LOOK")
    if wish.frame != "LOOK":
        return wish
    return _renamed(wish, "G", "T" if wish.has("T") else "L", [*wish.all("G")])


def _to_where(wish: Wish) -> Wish:
    """With what is named as its goal, which "to it" or "there" behind it only repeats."""
    if wish.verb == "leave":
        return replace(
            wish, fillers=tuple(replace(f, role="S") if f.role in "TG" else f for f in wish.fillers)
        )
    pointing = [f for f in wish.all("G") if {*f.words} <= _POINTING]
    if pointing and any(thing.start < f.start for thing in wish.all("T") for f in pointing):
        wish = replace(wish, fillers=tuple(f for f in wish.fillers if f not in pointing))
    listed = [f for f in wish.all("T") if any(0 <= f.start - g.end <= _JOINED for g in wish.all("G"))]
    wish = _renamed(wish, "T", "G", listed if wish.has("G") else [*wish.all("T")])
    here = [f for f in wish.all("S") if {*f.words} <= _FROM_THERE]  # that is where it is then
    return _gone(replace(wish, fillers=tuple(f for f in wish.fillers if f not in here)))


def _asked_by(filler: Filler, lexicon: Lexicon) -> tuple[Filler, ...]:
    """Whose question it is and where; nothing of a filler that only says that it is one: "their question"."""
    at = next((n for n, word in enumerate(filler.words) if word in _QUESTION), len(filler.words))
    who = [word for word in filler.words[:at] if word not in lexicon.classes["determiners"]]
    behind, asked = filler.words[at + 1 :], at < len(filler.words)
    if filler.role == "R" and filler.words[0] == "of" and len(filler.words) > 1:
        return (replace(_without_first(filler), role="R", share=1.0),)
    if asked and not who and len(behind) > 1 and behind[0] in ("of", "from", "by"):  # "the question of Kim"
        said = " ".join(filler.text.split()[at + 2 :])
        return (Filler("R", filler.start + at + 2, filler.end, len(behind) - 2, behind[1:], 1.0, said),)
    if filler.role not in "XTR" or (who and not asked) or (behind and behind[0] not in _AT):
        return (filler,)
    found = [Filler("L", filler.end, filler.end, len(behind) - 1, behind)] if behind else []
    if who and who[-1] not in _OWN:
        return (filler,)
    if name := tuple(who[:-1]):
        share = 1.0 if behind else filler.share  # the words around it say what it is
        text = filler.text.partition("'")[0].partition("’")[0]
        found.append(Filler("R", filler.start, filler.end, len(name) - 1, name, share, text))
    return tuple(found)


_OWN = frozenset({"'s", "’s", "'"})


def _looked_at(wish: Wish) -> Wish:
    """Looking on a thing is looking at it: "look on the desk"; telling me something is saying it."""
    thing = wish.one("T")
    bare = [word for word in thing.words if word != "the"] if thing is not None else []
    if wish.frame == "LOOK" and thing is not None and tuple(bare[:2]) in _NUMBERS and len(bare) > 2:
        return replace(wish, frame="COUNT", fillers=(_counted(thing, bare[2:]), *wish.all("L")))
    if wish.frame != "LOOK" or wish.has("TK"):
        return wish
    said = {word for f in wish.fillers for word in f.words}
    if said <= _HEREABOUTS and (said | {*wish.verb.split()}) & _HEREABOUTS:  # "look around"
        end = wish.start + len(wish.verb.split())
        here = Filler("K", end, end, 4, _WHAT_IS_HERE, 1.0, " ".join(_WHAT_IS_HERE))
        return replace(wish, fillers=(here,))
    on = [f for f in wish.all("L") if f.words[0] in _LOOKED_ON and len(f.words) > 1]
    return replace(wish, frame="SAY") if wish.has("X") else _renamed(wish, "L", "T", on)


_WHAT_IS_HERE = ("what", "can", "be", "seen", "here")


def looks_here(wish: Wish) -> bool:
    """Whether it is a look at nothing that is named: "look around"."""
    return any(filler.words == _WHAT_IS_HERE for filler in wish.all("K"))


def _met(wish: Wish, lexicon: Lexicon) -> Wish:
    """Where somebody or something is, as its place: "to Kim by the gate", "meet Kim at the gate"."""
    mine = [f for f in wish.all("T") if {*f.words} <= lexicon.classes["me"]]
    if wish.frame == "FIND" and mine and wish.has("L"):  # "meet me at the desk"
        met = replace(wish, frame="GO", fillers=tuple(f for f in wish.fillers if f not in mine))
        return _renamed(met, "L", "G", [*met.all("L")])
    if wish.frame == "FIND" and not wish.has("T") and wish.has("L"):  # "locate the office"
        return _renamed(replace(wish, frame="GO"), "L", "G", [*wish.all("L")])
    if wish.frame == "FIND" and not wish.has("T"):
        wish = _renamed(wish, "G", "T", [f for f in wish.all("G") if f.words[0] not in _AT])
    if wish.frame == "FIND" or wish.has("R"):
        wish = _renamed(wish, "G", "L", [f for f in wish.all("G") if f.words[0] in _AT])
    if wish.frame != "FIND" and not wish.has("T") and len(wish.all("R")) == 2:
        wish = _renamed(wish, "R", "T", [*wish.all("R")[:1]])  # "give them to me"
    return wish


def _seen(wish: Wish) -> Wish:
    """Telling what is seen is looking, and counting where it is how many."""
    said = wish.all("K")[0]
    if wish.frame == "SAY" and (wish.has("XT") or said.words[0] not in _TOLD_OF):
        return wish
    plain = said.words[0] not in _TOLD_OF and not {*said.words} & _SUCH
    if wish.frame == "LOOK" and plain and {"is", "are"} & {*said.words[1:-1]}:  # "verify the bay is clear"
        words, text = ("whether", *said.words), f"whether {said.text}"
        stated = replace(said, head=said.head + 1, words=words, said=text)
        return replace(wish, fillers=tuple(stated if f is said else f for f in wish.fillers))
    wish = replace(wish, frame="LOOK" if wish.frame == "SAY" else wish.frame)
    behind = [f for f in wish.fillers if f.start >= said.end and f.role in "TL"]
    if len(said.words) == 1 and behind and behind[0].start - said.end <= 1:
        said = _run(said, behind)  # "what | the box on the desk | is"
        wish = replace(wish, fillers=(*(f for f in wish.fillers if f.role != "K" and f not in behind), said))
    bare = [word for word in said.words if word not in _BEING | {"the", "what", "whats"}]
    if tuple(bare[:2]) not in {("how", "many"), *_NUMBERS} or len(bare) < 3:
        return wish
    counted = _counted(said, bare[2:])
    return replace(wish, frame="COUNT", fillers=(counted, *(f for f in wish.fillers if f.role in "TLG")))


def _counted(said: Filler, words: list[str]) -> Filler:
    """What is counted, of the words that ask how many there are."""
    head = next(
        (at for at, word in enumerate(words) if at and (word in _AT or word.endswith("ing"))), len(words)
    )
    return Filler("T", said.start, said.end, head - 1, tuple(words), said.share, " ".join(words))


def _run(first: Filler, others: list[Filler]) -> Filler:
    """Several roles side by side as one."""
    words = (*first.words, *(word for one in others for word in one.words))
    text = " ".join([first.text, *(one.text for one in others)])
    share = min(one.share for one in (first, *others))
    return Filler(first.role, first.start, others[-1].end, len(words) - 1, words, share, text)


def _gone(wish: Wish) -> Wish:
    """Going with somebody is following, by an angle turning, without a goal moving."""
    amount = next((amount_of(filler.words) for filler in wish.all("N")), None)
    verb = wish.verb.split()
    told = {word for filler in wish.fillers for word in filler.words}
    if {*verb} & {"come", "return"} and told <= _HITHER and {*verb, *told} & {"back", "return"}:
        return replace(wish, verb="come back", fillers=())
    wish = replace(wish, fillers=tuple(part for f in wish.fillers for part in _with_whom(f)))
    company = [filler for filler in wish.all("G") if filler.words[0] == "with" and len(filler.words) > 1]
    if company:
        rest = (f for f in wish.fillers if f not in company)
        return replace(wish, frame="FOLLOW", fillers=(*rest, *(_without_first(f) for f in company)))
    if wish.has("G"):
        return wish
    if amount is not None and amount.kind == "angle":
        return replace(wish, frame="TURN")
    backing = not wish.fillers and any(word in BACKING for word in verb) and verb[0] not in ("come", "get")
    return replace(wish, frame="MOVE") if wish.has("HN") or backing else wish


def _with_whom(filler: Filler) -> tuple[Filler, ...]:
    """A goal apart from who comes along: "to the desk", "with her"."""
    at = len(filler.words) - _WITH_HER
    if filler.role != "G" or at < 1 or filler.words[at] != "with" or filler.words[-1] not in _COMPANY:
        return (filler,)
    middle, said = filler.start + at, filler.text.split()
    words, company = filler.words[:at], filler.words[at:]
    return (
        Filler("G", filler.start, middle, min(filler.head, at - 1), words, filler.share, " ".join(said[:at])),
        Filler("G", middle, filler.end, 1, company, filler.share, " ".join(said[at:])),
    )


_AFTER = frozenset({"behind", "after"})


def _without_first(filler: Filler) -> Filler:
    """Whom alone, without the "with" or "behind" before it."""
    words, said = filler.words[1:], filler.text.partition(" ")[2]
    return Filler("T", filler.start + 1, filler.end, max(filler.head - 1, 0), words, filler.share, said)


_WITH_HER = 2
_COMPANY = frozenset({"him", "her", "them"})


def _renamed(wish: Wish, role: str, other: str, fillers: list[Filler]) -> Wish:
    if not fillers:
        return wish
    return replace(
        wish,
        fillers=tuple(replace(f, role=other) if f.role == role and f in fillers else f for f in wish.fillers),
    )


def _is_direction(filler: Filler, lexicon: Lexicon) -> bool:
    """For "to your left", "forward": nothing but a direction."""
    small = lexicon.classes["prepositions"] | lexicon.classes["determiners"] | {"side", "direction"}
    rest = [word for word in filler.words if word not in small]
    return bool(rest) and all(direction_of([word], lexicon) for word in rest)
