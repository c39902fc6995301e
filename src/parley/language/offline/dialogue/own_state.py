"""Questions about the robot itself: what it can do, does, plans, knows and where it is."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from parley.language.offline.facts.remembering import Remembered, find_fact
from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.abilities import abilities
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.saying import listing, the, whole_sentence
from parley.language.offline.words.text import Phrase, keys, plain, singular, split_name, tokens
from parley.messages.chat import ActionCall

__all__ = ["ABOUT_ITSELF", "step_words", "told_about"]


def _say_abilities(scene: Scene, _: Phrase) -> str:
    return abilities(scene)


def _say_status(scene: Scene, _: Phrase) -> str:
    situation = scene.situation
    if not situation.queue:
        return (
            "I have nothing to do at the moment: I am free and waiting for your instructions."
            if situation.status != "paused"
            else "I am standing still; say “carry on” when I may go on."
        )
    now = step_words(situation.queue[0])
    if situation.status == "paused":
        return f"I am paused. Next I would {now}."
    more = [step_words(step) for step in situation.queue[1:] if step.reason or _named(step)]
    rest = f" After that: {listing(more[:_MOST_NAMED], 'and then')}." if more else ""
    left = f" {len(more) - _MOST_NAMED} more follow." if len(more) > _MOST_NAMED else ""
    return f"I am at this step: {now}.{rest}{left}"


_MOST_NAMED = 4


def _named(step: ActionCall) -> bool:
    """Whether a step says in words what it is about, or has nothing to say."""
    return not step.input_parameters or any(
        isinstance(p.value, str) and p.value for p in step.input_parameters.values()
    )


def _say_left(scene: Scene, _: Phrase) -> str:
    queue = scene.situation.queue
    if not queue:
        return "Nothing is left to do. I am waiting for your instructions."
    steps = [step_words(step) for step in queue]
    return f"{len(steps)} {'step is' if len(steps) == 1 else 'steps are'} left: {listing(steps, 'and then')}."


def _say_where(scene: Scene, _: Phrase) -> str:
    pose = scene.situation.robot_pose
    if pose is None:
        return "I do not know where I am."
    near = sorted(scene.objects, key=lambda item: (item.x_m - pose.x_m) ** 2 + (item.y_m - pose.y_m) ** 2)
    nearest = f" The nearest thing I know is {the(describe(near[0], scene.objects))}." if near else ""
    return f"I am at x {pose.x_m:.1f} m, y {pose.y_m:.1f} m on the map.{nearest}"


def _say_name(scene: Scene, _: Phrase) -> str:
    name = _called(scene) or scene.situation.robot
    return (
        f"I am {name}, a robot that you can talk to. {abilities(scene)}"
        if name
        else f"I am a robot that you can talk to. {abilities(scene)}"
    )


def _called(scene: Scene) -> str:
    """The name that the operator gave the robot; empty if none."""
    for entry in reversed(scene.situation.memory):
        words = tuple(word for word in tokens(entry.data) if word.is_word)
        flat = keys(words)
        lead = next((lead for lead in _NAMES if flat[: len(lead)] == lead), ())
        if entry.type == "text" and lead and 0 < len(words) - len(lead) < 4:
            return plain(words[len(lead) :])
    return ""


_NAMES = (("you", "are", "called"), ("your", "name", "is"), ("you", "are", "named"), ("you", "go", "by"))


def _say_objects(scene: Scene, _: Phrase) -> str:
    if not scene.objects:
        return "I know no objects: my map has none."
    names = [the(describe(item, scene.objects)) for item in scene.objects]
    shown = names[:30]
    more = f" and {len(names) - 30} more" if len(names) > 30 else ""
    return f"On my map are {listing(shown) if not more else ', '.join(shown)}{more}."


def _say_memory(scene: Scene, rest: Phrase) -> str:
    about = bare(rest)
    while (
        about
        and about[0].key
        in {"about", "of", "regarding", "on", "now", "so", "far", "i", "told", "you", "concerning"}
        and len(about) > 1
    ):
        about = bare(about[1:])
    if not about or keys(about)[0] in {
        "about",
        "of",
        "everything",
        "anything",
        "so",
        "now",
        "far",
        "i",
        "all",
    }:
        if not scene.situation.memory:
            return "You have not told me anything to remember yet."
        return "I remember: " + " ".join(
            whole_sentence(entry.data[:200] if entry.type == "text" else entry.info)
            for entry in scene.situation.memory[-20:]
        )
    about = scene.referent(about)
    found = told_about(about, scene)
    for item in found:
        scene.use(item)
    if found:
        return " ".join(whole_sentence(item.fact.sentence) for item in found)
    on_map = ground_phrase(about, scene.objects)
    if on_map.outcome != "none":
        names = listing([the(describe(item, scene.objects)) for item in on_map.candidates])
        return f"I know {names} on the map, and nothing else about it."
    return f"I do not know anything about {the(plain(about))}. Tell me, and I will remember it."


def told_about(about: Phrase, scene: Scene) -> list[Remembered]:
    """Facts of which something is the subject or the place."""
    fact, several = find_fact(about, scene.facts, locations=False)
    direct = [fact] if fact is not None else several
    direct = [*direct, *_more_of(direct, scene)]
    names = {item.entry.name for item in direct}
    wanted = set(noun_phrase(about).core)
    related = [
        i
        for i in scene.facts
        if i.entry.name not in names
        and wanted
        and (
            wanted <= set(noun_phrase(i.fact.place).core)
            or wanted <= {singular(k) for k in keys(i.fact.state)}
        )
    ]
    return [*direct, *related]


def _more_of(told: Sequence[Remembered], scene: Scene) -> list[Remembered]:
    """What else is remembered of the same thing, in other respects."""
    subjects = {keys(item.fact.subject) for item in told}
    respects = {_respect(item) for item in told}
    result: list[Remembered] = []
    for item in scene.facts:
        if keys(item.fact.subject) in subjects and _respect(item) not in respects:
            respects.add(_respect(item))
            result.append(item)
    return result


def _respect(item: Remembered) -> tuple[object, ...]:
    fact = item.fact
    return (
        (keys(fact.subject), "where")
        if fact.is_location
        else (keys(fact.subject), fact.relation, item.entry.name)
    )


def _say_robots(scene: Scene, _: Phrase) -> str:
    robots = scene.situation.robots or ((scene.situation.robot,) if scene.situation.robot else ())
    return f"The robots here are {listing(list(robots))}." if robots else "I do not know of any other robots."


ABOUT_ITSELF: dict[str, Callable[[Scene, Phrase], str]] = {
    "ability": _say_abilities,
    "status": _say_status,
    "left": _say_left,
    "objects": _say_objects,
    "memory": _say_memory,
    "self": _say_where,
    "name": _say_name,
    "robots": _say_robots,
}


def step_words(step: ActionCall) -> str:
    """A step in words."""
    if step.reason:
        return step.reason
    values = [str(p.value) for p in step.input_parameters.values() if isinstance(p.value, str)]
    return " ".join([*split_name(step.name), *values])
