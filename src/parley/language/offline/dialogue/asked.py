"""Questions in other words: by what they ask for and about, wherever in the sentence it stands.

How much is left and what comes when, why, how far, who or what is somewhere, all that was told, what was
seen.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from parley.language.offline.dialogue.about_map import Answer
from parley.language.offline.dialogue.about_told import own_taste, taught, where_before
from parley.language.offline.dialogue.of_plan import of_plan
from parley.language.offline.dialogue.own_state import step_words, told_about
from parley.language.offline.facts.remembering import newest
from parley.language.offline.plan_changes.replanning import Visit, visit_of, visits
from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.scene.states import all_in_state
from parley.language.offline.tasks.abilities import abilities
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.saying import listing, the, whole_sentence
from parley.language.offline.words.text import Phrase, keys, lemma, singular, tokens

__all__ = ["asked", "told_of"]

_Reader = Callable[[Phrase, tuple[str, ...], Scene], Answer | None]

_LEFT = frozenset({
    "left", "remain", "remains", "remaining", "more", "still", "ahead", "outstanding", "open", "yet",
    "pending", "further", "missing", "undone", "else",
})  # fmt: skip
_STOPS = frozenset({
    "stop", "step", "place", "job", "task", "visit", "station", "thing", "item", "order", "work", "go",
    "do", "action", "errand", "point", "list", "plan", "queue", "agenda",
    "schedule", "round", "tour", "programme",
})  # fmt: skip
_QUANTITY = (("how", "many"), ("how", "much"), ("what",), ("which",), ("is", "there"), ("are", "there"),
             ("have", "you"), ("do", "you"), ("anything",))  # fmt: skip
_WHO = frozenset({"who", "whom", "anybody", "anyone", "somebody", "someone"})
_WHAT = frozenset({"what", "which", "anything", "something", "things"})
_HERE = frozenset({
    "is", "are", "was", "can", "could", "would", "do", "does", "might", "will", "should", "kept", "keep",
    "find", "stored", "store", "meet", "see", "there", "lie", "lies", "lying", "i", "you", "we", "have",
    "has", "got", "know", "now", "currently", "right", "at", "the", "moment", "to", "be", "stands",
    "standing", "sits", "sitting", "located", "waiting", "staying", "works", "working", "usually",
    "normally", "today", "all", "else", "hidden", "put", "placed", "things", "people", "lives", "sleeps",
    "stuff", "of", "anything", "tell", "me", "get",
})  # fmt: skip
_SEEING = frozenset(
    {"see", "seen", "saw", "find", "found", "notice", "noticed", "discover", "discovered", "observe"}
)
_TOLD = frozenset({
    "remember", "remembered", "told", "memory", "memories", "noted", "mind", "memorised", "memorized",
    "recall", "learned", "learnt", "stored", "saved", "said", "facts", "notes", "note", "know",
})  # fmt: skip
_ABOUT_TELLING = frozenset({
    "what", "all", "everything", "list", "which", "things", "you", "have", "has", "i", "we", "me", "us",
    "so", "far", "do", "did", "in", "your", "of", "that", "keep", "kept", "is", "are", "the", "facts",
    "tell", "there", "give", "show", "been", "to", "already", "now", "currently", "stuff", "information",
    "about", "anything", "ever", "sum", "up", "read", "out", "repeat", "recite", "else", "were", "got",
    "please", "can", "could", "full", "whole", "a", "as", "my", "notes", "on", "file",
})  # fmt: skip
_TALENTS = frozenset({
    "able", "use", "good", "useful", "suit", "suits", "jobs", "help", "trained", "purpose", "talents",
    "abilities", "capable", "tricks", "skills", "offer", "job", "made", "meant", "built", "strengths",
})  # fmt: skip
_ABOUT_TALENTS = frozenset({
    "what", "which", "kind", "kinds", "sort", "sorts", "of", "are", "is", "you", "your", "for", "at",
    "in", "to", "do", "can", "any", "anything", "have", "a", "the", "me", "us", "with", "things", "i",
    "we", "tasks", "robot", "really", "all", "so", "on", "be", "here", "how", "could", "work", "give",
    "learned", "learnt", "like", "you're", "use", "else", "able", "what's", "does", "well",
})  # fmt: skip
_TELLING_TO = frozenset({"tell", "ask", "order", "have", "get", "give", "say"})
_LANGUAGES = frozenset({
    "german", "french", "spanish", "estonian", "russian", "english", "finnish", "chinese", "italian",
    "portuguese", "polish", "arabic", "hindi", "japanese", "turkish", "dutch", "swedish", "language",
    "languages", "latvian", "ukrainian",
})  # fmt: skip


def asked(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """The answer to a question in other words; None if it is none of these.

    Args:
        words: The words of the question, without what is wrapped around it.
        flat: The same, as they are compared.
        scene: What is known.
    """
    if len(flat) > 16:
        return None
    return next((found for reader in _READERS if (found := reader(words, flat, scene)) is not None), None)


def _why(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """For "why are you going there?", "what are you doing that for?"."""
    why = flat[0] == "why" or flat[:2] in {("what", "for"), ("how", "come")} or flat[-2:] == ("what", "for")
    why = why or (
        flat[:3] in {("for", "what", "reason"), ("what", "is", "the"), ("what", "makes", "you")}
        and (bool({"reason", "purpose", "makes"} & set(flat)))
    )
    if (
        not why
        or "you" not in flat
        or flat[1:4] in {("do", "not", "you"), ("not", "you")}
        or ({"not"} & set(flat[1:3]) and flat[1] not in lexicon().be)
    ):
        return None
    if scene.situation.status == "paused" and _STANDING & set(flat):
        return Answer("Because I was told to stop. Say “carry on” when I may go on.")
    said = next((t.content for t in reversed(scene.situation.history) if t.role == "operator"), "")
    if said and scene.situation.queue:
        return Answer(f"Because you asked me to: “{said.strip()[:200]}”")
    if scene.situation.queue:
        return Answer(f"You asked me to: {step_words(scene.situation.queue[0])}.")
    return Answer("I am not doing anything at the moment; I wait until you tell me what to do.")


_STANDING = frozenset({
    "stop", "stopped", "stopping", "stand", "standing", "wait", "waiting", "pause", "paused", "still", "move",
    "moving", "halt", "halted", "idle", "stuck",
})  # fmt: skip


def _left(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """For "how many stops are left?", "have you still got much to do?", "which jobs remain?"."""
    counted = {singular(word) for word in flat} & _STOPS
    starts = any(flat[: len(q)] == q for q in _QUANTITY)
    mine = not noun_phrase(words).relation or bool({"plan", "list", "queue", "tour", "round"} & set(flat))
    if not (starts and counted and _LEFT & set(flat) and mine) or "of" in flat[-3:-1] or "know" in flat:
        return None
    listed = visits(scene)
    if not listed:
        return Answer("Nothing is left to do. I am waiting for your instructions.")
    names = [_name(visit) for visit in listed]
    steps = len(scene.situation.queue)
    count = f"{len(listed)} {'stop is' if len(listed) == 1 else 'stops are'} left"
    return Answer(
        f"{count} ({steps} {'step' if steps == 1 else 'steps'} in all): {listing(names, 'and then')}."
    )


def _name(visit: Visit) -> str:
    return the(visit.names[0]) if visit.names else step_words(visit.steps[0])


def _order_of(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """For "what comes after the desk?", "when will you get to the desk?"."""
    listed = visits(scene)
    if not listed or flat[0] not in {"what", "where", "when", "which", "how", "who"}:
        return None
    at = next((i for i in range(1, len(flat) - 1) if flat[i] in {"after", "before", "following"}), 0)
    kind = flat[1:2] if flat[0] in {"what", "which"} else ()
    small = not at or set(flat[:at]) - set(kind) <= _COMING
    present = at and set(flat[at + 1 :]) <= _PRESENT
    index = next((i for s in range(1, len(flat)) if (i := visit_of(words[s:], scene)) is not None), None)
    index = 0 if present else index
    if index is None or not small:
        return None
    if at:
        others = listed[index + 1 :] if flat[at] != "before" else listed[:index][::-1]
        if not others:
            return Answer(
                f"Nothing comes {'before' if flat[at] == 'before' else 'after'} {_name(listed[index])}."
            )
        return Answer(f"{whole_sentence(f'{_name(others[0])} comes {flat[at]} {_name(listed[index])}')}")
    if flat[0] == "when" or flat[:2] in {("how", "soon"), ("how", "long")}:
        place = f"stop {index + 1} of {len(listed)}"
        after = f", after {listing([_name(v) for v in listed[:index]])}" if index else ", the next one"
        return Answer(f"{whole_sentence(f'{_name(listed[index])} is {place}{after}')}")
    return None


_COMING = frozenset({
    "what", "where", "which", "comes", "come", "is", "next", "will", "do", "you", "go", "to", "are",
    "going", "stop", "place", "does", "then", "be", "happens", "right", "directly", "one", "visit",
    "driving", "the", "planned", "follows", "heading", "your", "straight", "immediately", "doing",
    "stands", "up", "off", "after", "following", "plan", "would", "should", "supposed", "have",
})  # fmt: skip


def _last_stop(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """For "what do you do last?", "where will you end up?"."""
    listed = visits(scene)
    last = {"last", "finally", "lastly"} & set(flat) or flat[-2:] == ("end", "up") or flat[-1] == "finish"
    if not listed or flat[0] not in {"what", "where", "which"} or not last or _SPEAKING & set(flat):
        return None
    return Answer(whole_sentence(f"{_name(listed[-1])} comes last"))


_SPEAKING = frozenset({"i", "told", "said", "asked", "ordered", "saw", "see", "seen", "found", "did", "was"})
_PRESENT = frozenset({
    "this", "that", "it", "the", "one", "you", "are", "on", "at", "now", "current", "present", "right",
    "moment", "stop", "step", "task", "job", "place", "doing", "currently", "here", "your", "of", "going",
    "to", "in", "visiting", "checking", "is",
})  # fmt: skip
"""What names the stop that the robot is at."""


def _far(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """For "how far is it to the desk?", "what is the distance to A?"."""
    pose = scene.situation.robot_pose
    asks = flat[:2] == ("how", "far") or "distance" in flat or flat[:3] == ("how", "many", "metres")
    if (
        not asks
        or pose is None
        or "between" in flat
        or ({"from"} & set(flat[:-2]) and "to" in flat[flat.index("from") :])
    ):
        return None
    named = _named(words, scene)
    found = ground_phrase(named, scene.objects, pose) if named else None
    if found is None or found.outcome != "match":
        return None
    item = found.candidates[0]
    away_m = math.hypot(item.x_m - pose.x_m, item.y_m - pose.y_m)
    return Answer(whole_sentence(f"{the(describe(item, scene.objects))} is about {away_m:.1f} m from here"))


def _named(words: Phrase, scene: Scene) -> Phrase:
    """The longest part that names one thing on the map, or what is remembered to be at one."""
    for size in range(min(6, len(words)), 0, -1):
        for start in range(len(words) - size, -1, -1):
            part = bare(words[start : start + size])
            known = part and (size > 1 or part[0].key not in lexicon().small)
            if known and ground_phrase(part, scene.objects, strict=True).outcome == "match":
                return part
    text = f" {' '.join(keys(words))} "
    facts = (f.fact for f in reversed(scene.facts) if f.fact.is_location and not f.fact.negated)
    return next((f.place for f in facts if f.subject and f" {' '.join(keys(f.subject))} " in text), ())


def _somewhere(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """For "who can I meet at the desk?", "is anybody in the hall?": what is remembered to be there."""
    said = set(flat)
    who, what = bool(said & _WHO), bool(said & _WHAT)
    at = next((i for i in range(1, len(flat) - 1) if lexicon().places.match(flat, i)), 0)
    found = lexicon().places.match(flat, at) if at else None
    if not (who or what) or found is None or not set(flat[:at]) <= _HERE | _WHO | _WHAT:
        return None
    tail = words[at + found[0] :]
    while len(tail) > 1 and tail[-1].key in {
        "now",
        "right",
        "today",
        "currently",
        "moment",
        "usually",
        "at",
        "present",
    }:
        tail = tail[:-1]
    wanted = set(noun_phrase(bare(tail)).core)
    hits = [f for f in newest(scene.facts) if wanted and wanted <= set(noun_phrase(f.fact.place).core)]
    persons = [f for f in hits if scene.is_person(f.fact.subject)]
    hits = persons if who and not what else [f for f in hits if f not in persons] or hits
    if not hits:
        return None
    for item in hits:
        scene.use(item)
    lead = "Yes: " if flat[0] in lexicon().be | {"do", "does"} else ""
    return Answer(lead + " ".join(whole_sentence(item.fact.sentence) for item in hits))


def _all_told(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """For "what all have I told you?", "list your memories"."""
    said = set(flat)
    whole = said - _TOLD <= _ABOUT_TELLING and bool(said & _TOLD)
    people = bool({"who", "whom", "people"} & said) and said <= {
        "who",
        "whom",
        "do",
        "you",
        "know",
        "of",
        "about",
        "people",
        "which",
        "all",
    }
    if people and "know" in said:
        known = [f for f in scene.facts if scene.is_person(f.fact.subject)]
        text = " ".join(dict.fromkeys(whole_sentence(f.fact.sentence) for f in known))
        return Answer(f"I know of them: {text}" if known else "You have not told me of anybody yet.")
    if (
        not whole
        or len(
            said & {"what", "all", "everything", "list", "which", "anything", "facts", "notes", "memories"}
        )
        == 0
    ):
        return None
    if flat[-1] == "about" or not scene.situation.memory:
        return None if flat[-1] == "about" else Answer("You have not told me anything to remember yet.")
    entries = scene.situation.memory[-20:]
    told = [whole_sentence(entry.data[:200] if entry.type == "text" else entry.info) for entry in entries]
    return Answer("I remember: " + " ".join(told))


_ABOUT = frozenset({"about", "on", "regarding", "concerning"})
_ON = frozenset({"anything", "something", "information", "info", "details", "what", "notes"})
_ASKS_ABOUT = _ON - {"what"} | frozenset({
    "all", "everything", "more", "news", "facts", "know", "tell", "heard", "told", "mention", "mentioned",
    "hear", "have", "got",
})  # fmt: skip
_AROUND_ABOUT = frozenset({
    "tell", "me", "us", "got", "have", "has", "do", "did", "you", "i", "we", "know", "any", "give", "is",
    "there", "can", "what", "could", "a", "bit", "little", "the", "been", "ever", "of", "please", "again",
    "that", "for", "to", "show", "remember", "in", "your", "memory", "else", "so", "far", "now", "already",
})  # fmt: skip


_TROUBLE = frozenset({
    "wrong", "matter", "problem", "problems", "issue", "issues", "trouble", "up", "happened", "amiss",
    "broken",
})  # fmt: skip


def told_of(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """For "got anything on A?", "tell me all about A", "did I tell you about A?": all that was told of A.

    Args:
        words: The words of the question, or of the request to tell.
        flat: The same, as they are compared.
        scene: What is known.
    """
    at = next((i for i in range(1, len(flat) - 1) if flat[i] in _ABOUT | {"with"}), 0)
    lead = set(flat[:at])
    wrong = at and flat[at] == "with" and lead & _TROUBLE
    if not at or (not wrong and (flat[at] == "with" or not lead & _ASKS_ABOUT)):
        return None
    if not lead <= _ASKS_ABOUT | _AROUND_ABOUT | (_TROUBLE if wrong else frozenset()):
        return None
    if flat[at] == "on" and not lead & {
        "anything",
        "something",
        "information",
        "info",
        "details",
        "what",
        "notes",
    }:
        return None
    about = bare(words[at + 1 :])
    found = told_about(scene.referent(about), scene) if about else []
    if wrong:
        # Where something is says nothing of what is wrong with it, nor what is kept there.
        found = [item for item in found if not item.fact.is_location]
    for item in found:
        scene.use(item)
    text = " ".join(dict.fromkeys(whole_sentence(item.fact.sentence) for item in found))
    return Answer(text) if text else None


def _in_what_state(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """For "which rooms are taken?": those that are remembered to be so."""
    link = next((i for i in range(2, len(flat) - 1) if flat[i] in lexicon().be), 0)
    if flat[0] not in {"which", "what"} or not link or len(flat) - link > 3:
        return None
    found = all_in_state((*words[link + 1 :], *words[1:link]), scene.objects, scene.facts)
    if found is None:
        return None
    for fact in found[1]:
        scene.use(fact)
    names = listing([the(describe(item, scene.objects)) for item in found[0]])
    return Answer(f"As far as I know: {names}.")


def _saw(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """For "what did you see (at the desk)?": what was reported last about it."""
    past = flat[:3] in {
        ("what", "did", "you"),
        ("what", "have", "you"),
        ("did", "you", "see"),
        ("have", "you", "seen"),
    }
    if not past or flat[0] != "what" or not _SEEING & set(flat[3:5]):
        return None
    named = {singular(word) for word in noun_phrase(words[4:]).core} | {
        singular(w) for w in flat[5:] if w not in lexicon().vocabulary
    }
    for turn in reversed(scene.situation.history):
        if turn.role == "operator":
            continue
        about = {singular(lemma(word.key)) for word in tokens(turn.content)} | {
            singular(w.key) for w in tokens(turn.content)
        }
        reports = {"see", "saw", "seen", "look", "find", "found", "there"} & {
            w.key for w in tokens(turn.content.lower())
        } or ("looked" in turn.content.lower())
        future = "i will" in turn.content.lower()
        if reports and not future and (not named or named & about):
            return Answer(turn.content)
    return Answer("I have not looked at anything yet that I could tell you about.")


def _talents(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """For "what kinds of jobs suit you?", "are you good for anything?"."""
    said = set(flat)
    told_to = {"what", "which"} & {flat[0]} and {"can", "i", "you"} <= said and said & _TELLING_TO
    about = said <= _TALENTS | _ABOUT_TALENTS | _TELLING_TO and {"you", "your"} & said and len(flat) > 3
    if about and (said & _TALENTS or told_to):
        return Answer(abilities(scene))
    if said & _LANGUAGES and said <= _LANGUAGES | {
        "do",
        "can",
        "you",
        "speak",
        "understand",
        "know",
        "which",
        "what",
        "any",
        "other",
        "also",
        "talk",
        "in",
        "i",
        "to",
        "or",
        "does",
        "the",
        "are",
    }:
        if said & _LANGUAGES == {"english"}:
            return Answer("Yes, I understand plain English.")
        return Answer("I understand English only; “stop” I understand in some twenty languages.")
    return None


def _last_asked(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """For "what was the last thing I asked you to do?"."""
    asks = (
        flat
        in {
            ("what", "did", "i", "just", "say"),
            ("what", "did", "i", "say"),
            ("what", "was", "it", "i", "said"),
        }
        or flat[:4] in {("what", "did", "i", "ask"), ("what", "did", "i", "order")}
        or (
            flat[0] == "what"
            and "last" in flat
            and ({"i", "my"} & set(flat))
            and bool(
                {"asked", "ask", "order", "orders", "request", "command", "message", "said", "say", "told"}
                & set(flat)
            )
        )
    )
    if not asks:
        return None
    said = next((t.content for t in reversed(scene.situation.history) if t.role == "operator"), "")
    return Answer(
        f"You asked me: “{said.strip()[:200]}”" if said else "You have not asked me for anything yet."
    )


_READERS: tuple[_Reader, ...] = (
    own_taste,
    taught,
    where_before,
    _last_asked,
    _why,
    _order_of,
    _last_stop,
    of_plan,
    _left,
    _far,
    _saw,
    _all_told,
    _in_what_state,
    told_of,
    _talents,
    _somewhere,
)
