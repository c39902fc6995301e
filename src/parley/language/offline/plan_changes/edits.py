"""Changes of the plan and of memory: dropping steps, forgetting."""

from __future__ import annotations

from parley.language.offline.facts.facts import TASTES, read_statement, strip_openers
from parley.language.offline.facts.protocols import read_protocol
from parley.language.offline.facts.remembering import Remembered, find_fact
from parley.language.offline.facts.sharing import content_of, shared
from parley.language.offline.plan_changes.pending import pending_steps, ranked_steps, said_of
from parley.language.offline.plan_changes.replanning import Edit, pops
from parley.language.offline.scene.scene import Scene, UnclearError
from parley.language.offline.tasks.commands import Command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.saying import listing, the, whole_sentence
from parley.language.offline.words.text import Phrase, Word, keys, lemma, plain, singular, split_name, tokens
from parley.language.word_lists import load_data
from parley.messages.chat import SystemCommand
from parley.messages.memory import MemoryEntry

__all__ = ["drop_verb", "read_edit", "steps_of"]

_FORGET_STARTS = (
    ("forget",),
    ("do", "not", "remember"),
    ("delete",),
    ("remove",),
    ("erase",),
    ("unlearn",),
    ("clear",),
    ("wipe",),
)


def read_edit(words: Phrase, scene: Scene) -> Edit | None:
    """A change of plan or memory that a clause asks for, or None."""
    words = strip_openers(words, requests=True)
    words = tuple(word for word in words if word.is_word)
    dropped = _drop(words, scene)
    if dropped is not None and not scene.situation.queue and not dropped.commands:
        # "Forget about order 9" with nothing planned: what was told of it.
        forgotten = _forget(words, scene)
        return forgotten if forgotten is not None and forgotten.commands else dropped
    return dropped or _forget(words, scene)


def _drop(words: Phrase, scene: Scene) -> Edit | None:
    size = drop_verb(words)
    if not size or size >= len(words):
        return None
    named, queue = bare(words[size:]), scene.situation.queue
    asked = ranked_steps(named, max(len(queue), 1))
    if not queue and asked:
        return Edit((), "There is nothing planned that I could leave out.")
    if asked and max(asked) >= len(queue):
        text = f"There are only {len(queue)} steps left, so there is no step {max(asked) + 1}."
        return Edit((), text)
    forgets = lemma(words[0].key) == "forget"
    gone = asked if forgets else pending_steps(named, scene)
    said = [f"step {i + 1}: {said_of(queue[i])}" for i in gone]
    return Edit(pops(gone), f"I leave out {listing(said)}.") if gone else None


def drop_verb(words: Phrase) -> int:
    """How many words at the start ask for something to be left out; 0 if they do not."""
    flat = keys(words)
    if not flat:
        return 0
    verbs = lexicon().verb_classes["drop_step"]
    first = lemma(flat[0])
    return next((n for n in (3, 2, 1) if " ".join((first, *flat[1:n])) in verbs and n <= len(flat)), 0)


def steps_of(command: Command, scene: Scene) -> list[int]:
    """Pending steps that do what is forbidden, ascending; the one being executed is left alone."""
    target = plain(bare(command.place or command.theme)).lower()
    if not target:
        return []
    hits: list[int] = []
    for index, step in enumerate(scene.situation.queue):
        said = [p.value.lower() for p in step.input_parameters.values() if isinstance(p.value, str)]
        wanted = any(target in text or text in target for text in said if text)
        roles = [scene.catalogue.roles(info) for info in scene.catalogue.infos if info.name == step.name]
        carries_on = (
            bool(hits)
            and hits[-1] == index - 1
            and not said
            and command.kind == "motion"
            and any("motion" in r for r in roles)
        )
        looks = any(r & {"look", "search"} for r in roles)
        if index and (carries_on or (wanted and looks == (command.kind != "motion"))):
            hits.append(index)
    return hits


def _forget(words: Phrase, scene: Scene) -> Edit | None:
    flat = keys(words)
    untrue = _untrue(words)
    if untrue:
        return _forget_about(untrue, scene)
    start = next((s for s in _FORGET_STARTS if flat[: len(s)] == s), None)
    if start is None or len(flat) == len(start):
        return None
    strong = start in {("forget",), ("do", "not", "remember"), ("unlearn",)} or {
        "memory",
        "memories",
        "remember",
        "told",
        "know",
    } & set(flat)
    if not strong:
        return None
    if (
        flat[len(start) :]
        in {
            ("all", "that"),
            ("it", "all"),
            ("all", "of", "it"),
            ("all", "of", "that"),
            ("the", "plan"),
            ("all", "this"),
        }
        and scene.situation.queue
    ):
        return Edit((SystemCommand(command="clear"),), "I cancel everything that was planned.")
    rest = words[len(start) :]
    while (
        rest
        and rest[0].key
        in {
            "about",
            "what",
            "i",
            "told",
            "you",
            "said",
            "know",
            "ever",
            "where",
            "that",
            "everything",
            "all",
            "the",
            "fact",
            "memory",
            "of",
            "just",
            "who",
            "when",
            "how",
            "memories",
            "thing",
            "things",
            "stuff",
            "news",
            "my",
            "is",
            "are",
        }
        and len(rest) > 1
    ):
        rest = rest[1:]
    about = bare(rest)
    drop_tail = {"is", "are", "was", "anymore", "memory", "please", "said"}
    while about and about[-1].key in drop_tail and len(about) > 1:
        about = about[:-1]
    if keys(words[len(start) :]) in {("your", "memory"), ("your", "whole", "memory"), ("the", "memory")}:
        about = (Word("memories", "memories"),)
    everything = {"everything", "all"} & set(keys(words[len(start) : len(start) + 2]))
    said_only = set(keys(words[len(start) :])) <= lexicon().told
    if (everything and said_only) or keys(about)[-1:] == ("memories",):
        names = [entry.name for entry in scene.situation.memory]
        return Edit(
            tuple(_remove(name) for name in names),
            "I have forgotten everything you told me." if names else "There is nothing to forget.",
        )
    if not about or keys(about)[0] in {"that", "it", "this", "said", "told"}:
        if flat[1:] in {("it",), ("that",)} and not _just_remembered(scene):
            # "Forget it" gives up what was talked about; nothing that is known is lost.
            return Edit((), "All right, I leave it.")
        return _forget_last(scene)
    return _forget_about(about, scene)


def _untrue(words: Phrase) -> Phrase:
    """For "what I told you about A is no longer true", "... no longer holds": A."""
    flat = keys(words)
    if "about" not in flat[:8] or not {"told", "said", "thing", "fact", "mentioned"} & set(flat[:5]):
        return ()
    at = flat.index("about")
    ends = lexicon().be | {"no", "does", "do", "has", "holds", "never", "ceased", "applies"}
    link = next((i for i in range(at + 2, len(flat)) if flat[i] in ends), 0)
    return bare(words[at + 1 : link]) if link and set(flat[link:]) & _DENYING else ()


_DENYING = frozenset({
    "not", "no", "wrong", "false", "outdated", "obsolete", "incorrect", "untrue", "old", "never", "nonsense",
    "rubbish", "mistaken", "mistake", "ceased", "changed", "history", "lie",
})  # fmt: skip


def _remove(name: str) -> SystemCommand:
    return SystemCommand(command="remove_memory", arguments={"name": name})


def _forget_last(scene: Scene) -> Edit:
    """The newest fact, the one of the last message first of all."""
    if not scene.situation.memory:
        return Edit((), "There is nothing to forget.")
    stated = _stated_last(scene)
    if stated is not None:
        return Edit(
            (_remove(stated.entry.name),), f"I have forgotten: {whole_sentence(stated.fact.sentence[:200])}"
        )
    entry = max(enumerate(scene.situation.memory), key=lambda item: (item[1].updated_unix_ms, item[0]))[1]
    return Edit((_remove(entry.name),), f"I have forgotten: {whole_sentence(entry.data[:200])}")


def _stated_last(scene: Scene) -> Remembered | None:
    """The remembered fact that the operator stated in the message before, if any."""
    said = next((t.content for t in reversed(scene.situation.history) if t.role == "operator"), "")
    for sentence in said.split(". "):
        fact = read_statement(tokens(sentence))
        if fact is not None:
            return next(
                (known for known in scene.facts if keys(known.fact.subject) == keys(fact.subject)), None
            )
    return None


def _just_remembered(scene: Scene) -> bool:
    """Whether what was said last was a fact, or the newest memory was what was answered."""
    history, memory = scene.situation.history, scene.situation.memory
    if not history:
        return True
    last = history[-1].content.lower()
    newest = memory[-1].data.lower().strip(" .") if memory else ""
    return "remember" in last or "noted" in last or (bool(newest) and newest in last)


def _rule_about(about: Phrase, scene: Scene) -> MemoryEntry | None:
    """For "the rule about a blocked way", "what to do when you see X": the rule that shares most words."""
    flat = keys(about)
    if not _RULES & set(flat[:4]) and flat[:2] != ("to", "do"):
        return None
    small = _RULES | {"what", "when", "if", "about", "on", *load_data("protocols")["generic"]}
    wanted = {singular(key) for key in flat if key not in small}
    best: tuple[int, MemoryEntry | None] = (0, None)
    for entry in scene.situation.memory:
        rule = read_protocol(entry.data, kept=True) if entry.type == "text" else None
        said = {singular(key) for key in keys(tokens(entry.data))} if rule is not None else set()
        count = len(wanted & said)
        if rule is not None and (count > best[0] or (count and count == best[0])):
            best = (count, entry)
    return best[1]


_RULES = frozenset({"rule", "rules", "protocol", "instruction", "taught"})


def _forget_about(about: Phrase, scene: Scene) -> Edit:
    if len(about) == 1 and about[0].key in lexicon().person_pronouns:
        about = scene.referent(about)
    if keys(about[-1:])[0] in TASTES and len(about) <= 2:
        tastes = [item for item in scene.facts if item.fact.relation in TASTES and item.fact.another]
        if tastes:
            return Edit(tuple(_remove(item.entry.name) for item in tastes), "I have forgotten what you like.")
    rule = _rule_about(about, scene)
    if rule is not None:
        return Edit((_remove(rule.name),), f"I have forgotten: {whole_sentence(rule.data[:200])}")
    cut = next((i for i, word in enumerate(about) if word.key in lexicon().be and i), len(about))
    fact, several = find_fact(about[:cut], scene.facts, locations=False)
    hits = [fact] if fact is not None else several
    if len({item.entry.name for item in hits}) > 1:
        same = {keys(item.fact.subject) for item in hits}
        if len(same) > 1:
            raise UnclearError(
                f"Which should I forget: {' or '.join(whole_sentence(h.fact.sentence)[:-1] for h in hits)}?",
                [h.fact.sentence for h in hits],
            )
    if not hits:
        by_name = [e for e in scene.situation.memory if set(keys(about)) <= set(split_name(e.name))]
        wanted = content_of(about)
        by_name = by_name or [f.entry for f in scene.facts if wanted and shared(wanted, f) == len(wanted)]
        owner = next((i for i, word in enumerate(about[:-1]) if word.key.endswith("'s")), -1)
        if not by_name and owner >= 0:
            # "The hall's hours": what was told of the hall, if that is one thing.
            whose = Word(about[owner].key[:-2], about[owner].raw[:-2])
            told, _ = find_fact((*about[:owner], whose), scene.facts, locations=False)
            by_name = [told.entry] if told is not None else []
        if not by_name:
            return Edit((), f"I do not remember anything about {the(plain(about))}.")
        return Edit(
            tuple(_remove(e.name) for e in by_name),
            f"I have forgotten what you told me about {the(plain(about))}.",
        )
    subject = keys(hits[0].fact.subject)
    names = dict.fromkeys(item.entry.name for item in scene.facts if keys(item.fact.subject) == subject)
    return Edit(
        tuple(_remove(name) for name in names),
        f"I have forgotten what you told me about {the(plain(about[:cut]))}.",
    )
