"""English as learners and offices write it, put as it is usually said: "no go A", "a visit to A is required".

Only what no native speaker would mean otherwise is touched, and nothing between quotation marks.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.deeds import Deeds
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.rewriting import rewritten
from parley.language.offline.words.text import Phrase, Word, keys, tokens
from parley.language.word_lists import load_data, written_out

__all__ = ["usually_said"]

_DATA = load_data("learners")
_INSTEAD = PhraseTable(
    {
        one: plain or "-"
        for plain, said in _DATA["instead_of"].items()
        for phrase in said
        for one in written_out(phrase)
    }
)
_BEHIND_NOUNS = frozenset(tuple(phrase.split()) for phrase in _DATA["behind_nouns"])
_ASKED_FOR = PhraseTable.of(_DATA["asked_for"])
_NOUNS: dict[str, str] = dict(_DATA["nouns"])
_LIGHT = PhraseTable.of(_DATA["light_verbs"])
_CARRIED_OUT = PhraseTable.of(_DATA["carried_out"])
_TOLD_TO = PhraseTable.of(_DATA["told_to"])
_ASKING = PhraseTable.of(_DATA["asking"])
_WH_WORDS = frozenset(_DATA["wh_words"])
_STATES = frozenset(_DATA["states"])
_BARRED = PhraseTable.of(_DATA["barred"])
_MOTION = PhraseTable.of(_DATA["motion"])
_OF_ROBOT = PhraseTable.of(f"of {name}" for name in _DATA["of_robot"])
_ENDS = frozenset({".", "!", "?", ";", ",", ":", "\n", "and", "but", "then"})
_SENTENCE_ENDS = frozenset({".", "!", "?", ";", "\n"})
_FINITE = frozenset(
    {"is", "are", "was", "were", "has", "have", "be", "stands", "stand", "you", "find", "see", "there"}
)
_OF_NOUNS = ("ion", "al", "ery", "ure", "ing", "ment")
_PRONOUNS = frozenset(
    {"i", "we", "he", "she", "they", "it", "somebody", "someone", "anybody", "anyone", "nothing"}
)
_NAMES_MOST = 4


def usually_said(words: Phrase, scene: Scene) -> Phrase:
    """A message in the words that are usual for it.

    Args:
        words: All words and punctuation.
        scene: What is known: names of things, and what the robot can be asked for.
    """
    if '"' in keys(words):
        return words
    deeds = Deeds.of(scene)
    result = _requested(_plainer(words), deeds)
    result = _without_please(result, deeds.can)
    result = _with_is(_asked_straight(_forbidden(_afterwards(result, deeds), deeds)))
    return _with_to(_owners_first(result, scene), scene)


def _plainer(words: Phrase) -> Phrase:
    """With plain words for stilted and mistaken ones."""
    flat = keys(words)

    def put(at: int, before: Sequence[Word]) -> tuple[int, Phrase] | None:
        del before
        found = _INSTEAD.match(flat, at)
        if found is None or (flat[at : at + found[0]] in _BEHIND_NOUNS and not _after_noun(flat, at)):
            return None
        return found[0], tokens(found[1]) if found[1] != "-" else ()

    return rewritten(words, put)


def _after_noun(flat: tuple[str, ...], at: int) -> bool:
    """Whether what stands before is the end of a name with an article: "the bench what is ..."."""
    start = next(
        (i for i in range(at - 1, max(at - _NAMES_MOST, 0) - 1, -1) if flat[i] in {"the", "a", "an"}), -1
    )
    return 0 <= start < at - 1 and not any(not part[:1].isalnum() for part in flat[start:at])


def _requested(words: Phrase, deeds: Deeds) -> Phrase:
    """For "an examination of A for B is requested", "perform an examination of A for B" "examine A for B"."""
    flat = keys(words)
    end = next((i for i in range(len(flat)) if flat[i] in _SENTENCE_ENDS), len(flat))
    told = _TOLD_TO.match(flat)
    if told is not None and told[0] < end:
        return _requested(words[told[0] :], deeds)
    light = _LIGHT.match(flat)
    start = light[0] if light is not None else 0
    start += flat[start : start + 1] in {("a",), ("an",), ("the",), ("your",), ("another",)}
    asked = ((i, _ASKED_FOR.match(flat, i) or _CARRIED_OUT.match(flat, i)) for i in range(start, end))
    until, size = next(((i, found[0]) for i, found in asked if found is not None), (end, 0))
    deed = _named_deed(flat, start, deeds)
    clause = next((i for i in range(start, end) if flat[i] in _ENDS), end)
    noun = flat[start] if light is None and start < end else ""
    alone = noun in _NOUNS and noun.endswith(_OF_NOUNS) and not _FINITE & set(flat[:clause])
    if deed is None or not (size or light is not None or alone) or until <= deed[0]:
        return words
    return (*tokens(deed[1]), *words[deed[0] : until], *words[until + size :])


def _named_deed(flat: tuple[str, ...], at: int, deeds: Deeds) -> tuple[int, str] | None:
    """The deed in "inspection of A", "relocation of the robot to B", and where what it is done to begins."""
    noun = flat[at] if at + 2 < len(flat) else ""
    verb = _NOUNS.get(noun, "") or (deeds.noun(noun) if noun and noun not in deeds.own else "")
    at += 1
    if not verb or flat[at] not in {"of", "to", "on", "about", "in"}:
        return None
    robot = _OF_ROBOT.match(flat, at)
    at += robot[0] if robot is not None else flat[at] == "of"
    if verb == "tell me" and flat[at] in {"on", "about"}:
        return at + 1, "tell me" if flat[at + 1] in _WH_WORDS else "tell me about"
    return at + (verb.split()[-1] == flat[at]), verb


def _asked_straight(words: Phrase) -> Phrase:
    """For "tell me where is the A" "tell me where the A is", for "the A where is?" "where is the A?"."""
    flat = keys(words)
    last = len(words) - (bool(words) and not words[-1].is_word)
    if last > 2 and flat[last - 2] in _WH_WORDS and flat[last - 1] in {"is", "are"}:
        return (*words[last - 2 : last], *words[: last - 2], *words[last:])
    for at in range(len(flat)):
        asking = _ASKING.match(flat, at)
        at += asking[0] if asking is not None else len(flat)
        at += flat[at : at + 1] == ("please",)
        if flat[at : at + 1] == ("where",) and flat[at + 1 : at + 2] in {("is",), ("are",)}:
            end = next((i for i in range(at, len(flat)) if flat[i] in _ENDS), len(flat))
            if 0 < end - at - 2 <= _NAMES_MOST + 2:
                return (*words[: at + 1], *words[at + 2 : end], words[at + 1], *words[end:])
    return words


def _with_is(words: Phrase) -> Phrase:
    """For "if the door open, V" and "if is open the door" "if the door is open"."""
    flat = keys(words)
    for at in range(len(flat) - 2):
        if flat[at] not in {"if", "whether"}:
            continue
        end = next((i for i in range(at, len(flat)) if flat[i] in _ENDS), len(flat))
        said = flat[at + 1 : end]
        if said[:1] in {("is",), ("are",)} and len(said) > 2 and said[1] in _STATES:
            if said[2] in lexicon().determiners:
                return (*words[: at + 1], *words[at + 3 : end], *words[at + 1 : at + 3], *words[end:])
            return (*words[: at + 1], Word("it", "it"), *words[at + 1 :])
        bare = len(said) > 1 and said[-1] in _STATES and not (_FINITE | _PRONOUNS) & set(said)
        if bare and flat[at] == "if" and said[0] != "not" and end < len(flat):
            return (*words[: end - 1], Word("is", "is"), *words[end - 1 :])
    return words


def _without_please(words: Phrase, can: Callable[[str], bool]) -> Phrase:
    """Without "please" behind a verb or before "you": "mow please the lawn", "please you V"."""
    flat = keys(words)
    drop = set()
    for index in range(len(flat)):
        if flat[index] not in {"please", "kindly", "pls"}:
            continue
        if index + 1 < len(flat) and flat[index + 1] == "you":
            drop |= {index, index + 1} if index + 2 < len(flat) and can(flat[index + 2]) else {index}
        elif (
            index
            and (can(flat[index - 1]) or flat[index - 2 : index] == ("tell", "me"))
            and flat[index - 2 : index - 1] != ("to",)
        ):
            drop.add(index)
    return tuple(word for index, word in enumerate(words) if index not in drop)


def _forbidden(words: Phrase, deeds: Deeds) -> Phrase:
    """For "no go to A", "no weighing", "go not to A": "do not go to A", "do not weigh"."""
    flat = keys(words)
    barred = _BARRED.match_end(flat[: len(flat) - (flat[-1:] in {(".",), ("!",)})])
    if barred and (verb := deeds.doing(flat[0])) and len(flat) > barred + 1 and words[-1 - barred].is_word:
        end = len(flat) - (not words[-1].is_word) - barred
        return (*tokens(f"do not {verb}"), *words[1:end], *words[end + barred :])
    result: list[Word] = []
    for index, word in enumerate(words):
        begins = not index or flat[index - 1] in _ENDS
        after = flat[index + 1] if index + 1 < len(flat) else ""
        doing = deeds.doing(after)
        if word.key == "no" and begins and after and after not in lexicon().determiners:
            verb = after if index + 2 < len(flat) and _is_verb(after, deeds) else doing
            if verb and (_is_verb(verb, deeds) or deeds.can(verb)):
                result += tokens("do not")
                continue
        before = flat[index - 1] if index else ""
        if (
            word.key == "not"
            and after == "to"
            and (index == 1 or flat[index - 2] in _ENDS)
            and before == "go"
        ):
            result = [*result[:-1], *tokens("do not go")]
            continue
        if before == "no" and keys(result[-2:]) == ("do", "not") and deeds.doing(word.key):
            result += tokens(deeds.doing(word.key))
            continue
        result.append(word)
    return tuple(result)


def _afterwards(words: Phrase, deeds: Deeds) -> Phrase:
    """For "V, and after you W" "V, and then W"; for "A is dry, you water" "A is dry, water it"."""
    flat = keys(words)
    for at in range(2, len(flat) - 1):
        if flat[at - 1] not in {",", "and"}:
            continue
        end = next((i for i in range(at, len(flat)) if flat[i] in _ENDS), len(flat))
        last = end == len(flat) or flat[end] in _SENTENCE_ENDS
        you = flat[at + 1] == "you"
        verb = flat[at + 1 + you] if at + 1 + you < len(flat) else ""
        if flat[at] == "after" and last and _is_verb(verb, deeds) and (flat[at - 1] == "and" or not you):
            return (*words[:at], Word("then", "then"), *words[at + 1 + you :])
        if flat[at] == "you" and last and end == at + 2 and deeds.can(flat[at + 1]):
            return (*words[:at], words[at + 1], Word("it", "it"), *words[end:])
    return words


def _is_verb(word: str, deeds: Deeds) -> bool:
    found = lexicon().verbs.match((word,))
    return word in deeds.own or (found is not None and found[1].partition(":")[0] == "motion")


def _owners_first(words: Phrase, scene: Scene) -> Phrase:
    """For "the room of the caretaker" the name on the map, "caretaker's room"."""
    flat = keys(words)
    if "of" not in flat:
        return words
    named = {keys(tokens(item.description)) for item in scene.situation.objects}
    owned = {name for name in named if any(part.endswith(("'s", "s'")) for part in name)}
    for name in owned:
        owner = next(i for i, part in enumerate(name) if part.endswith(("'s", "s'")))
        possessor = (*name[:owner], name[owner].removesuffix("'s").removesuffix("'"))
        for article in (("the",), ()):
            turned = (*name[owner + 1 :], "of", *article, *possessor)
            for at in range(len(flat) - len(turned) + 1):
                if flat[at : at + len(turned)] == turned:
                    return (*words[:at], *tokens(" ".join(name)), *words[at + len(turned) :])
    return words


def _with_to(words: Phrase, scene: Scene) -> Phrase:
    """For "go loading area" "go to the loading area", if something on the map is called so."""
    flat = keys(words)
    moving = [i for i in range(len(flat) - 1) if (found := _MOTION.match(flat, i)) and found[0] == 1]
    names = {keys(tokens(item.description)) for item in scene.situation.objects} if moving else set()
    result: list[Word] = []
    for index, word in enumerate(words):
        at = index + 1
        result.append(word)
        if index in moving and any(flat[at : at + len(name)] == name for name in names):
            result += tokens("to" if words[at].is_capital else "to the")
    return tuple(result)
