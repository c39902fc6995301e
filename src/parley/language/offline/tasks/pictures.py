"""Looking at a picture through the words of the robot's own detector."""

from __future__ import annotations

from collections.abc import Sequence

from parley.errors import LanguageError
from parley.language.base import InspectionReport
from parley.language.offline.scene.called import head_of
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, coordinated, noun_phrase
from parley.language.offline.words.saying import a, listing, the, whole_sentence
from parley.language.offline.words.text import Phrase, keys, lemma, plain, singular, tokens
from parley.robots.base import CameraImage, Detection
from parley.world.object_map import MapObject

__all__ = ["MIN_PIXELS", "inspect"]

MIN_PIXELS = 40
"""Smaller finds are not trusted."""

_GENERAL = frozenset(
    [
        "what",
        "everything",
        "around",
        "surroundings",
        "area",
        "situation",
        "anything",
        "picture",
        "view",
        "scene",
        "overview",
        "room",
        "place",
        "here",
    ]
)
_LEADS = frozenset(
    [
        "is",
        "are",
        "there",
        "any",
        "if",
        "whether",
        "for",
        "of",
        "the",
        "at",
        "see",
        "look",
        "find",
        "check",
        "that",
        "does",
        "do",
        "you",
        "can",
    ]
)


def inspect(image: CameraImage, request: str) -> InspectionReport:
    """Say what a picture shows, with regard to `request`.

    Raises:
        LanguageError: The robot has no detector; pictures cannot be judged without a model then.
    """
    if image.detections is None:
        raise LanguageError(
            "this robot has no detector, and without a language model I cannot judge pictures"
        )
    seen = _distinct([d for d in image.detections if d.pixels >= MIN_PIXELS])
    subject, condition = _subject(tokens(request))
    if not subject or keys(subject)[0] in _GENERAL:
        return InspectionReport(
            _overview(seen, image) + _warning(_alarming(seen)), attention=bool(_alarming(seen))
        )
    name = plain(subject)
    alarming = _alarming(seen)
    found = [d for part in coordinated(subject) for d in _fitting(part, seen)]
    missing = [plain(part) for part in coordinated(subject) if not _fitting(part, seen)]
    if missing:
        others = (
            f" I can see {listing([a(d.label) for d in seen])}."
            if seen
            else " I can see nothing that I know."
        )
        return InspectionReport(
            f"I cannot see {a(listing(missing, 'or'))}.{others}{_warning(alarming)}",
            found=False,
            wanted=name,
            attention=bool(alarming),
        )
    places = listing([f"{a(d.label)}, {_where(d, image)}" for d in found])
    text = f"I can see {places}."
    if condition:
        text += (
            f" Whether {the(name)} {condition}, I cannot judge by myself: please have a look at the picture."
        )
    return InspectionReport(text + _warning(alarming), found=True, wanted=name, attention=bool(alarming))


def _alarming(seen: Sequence[Detection]) -> list[str]:
    """Labels of finds that a person should know of at once, whatever was asked."""
    hazards = lexicon().hazards
    return [d.label for d in seen if {singular(word.key) for word in tokens(d.label)} & hazards]


def _warning(alarming: Sequence[str]) -> str:
    return (
        f" Please decide what to do about {listing([the(label) for label in alarming])}." if alarming else ""
    )


def _distinct(detections: Sequence[Detection]) -> list[Detection]:
    """The largest find of each label, largest first."""
    best: dict[str, Detection] = {}
    for detection in detections:
        known = best.get(detection.label)
        if known is None or detection.pixels > known.pixels:
            best[detection.label] = detection
    return sorted(best.values(), key=lambda d: -d.pixels)


def _subject(words: Phrase) -> tuple[Phrase, str]:
    """What is looked for, and what is asked about it besides that it is there."""
    words = tuple(word for word in words if word.is_word or word.key == ",")
    while words and (
        words[0].key in _LEADS or lemma(words[0].key) in {"inspect", "look", "search", "verify"}
    ):
        words = words[1:]
    flat = keys(words)
    link = next(
        (
            i
            for i in range(1, len(flat))
            if flat[i] in lexicon().be | {"has", "have", "looks", "needs", "does", "seems", "stands"}
        ),
        len(flat),
    )
    rest = words[link:]
    condition = plain(rest)
    if rest and (
        lexicon().places.match(keys(rest), 1)
        or keys(rest)[1:2] in {("there",), ("here",), ("present",), ("visible",)}
    ):
        # "The box is on the desk": being there is all that is asked.
        condition = ""
    noun = noun_phrase(words[:link])
    return bare(noun.phrase[: len(noun.phrase)]) if noun.core else (), condition


def _fitting(subject: Phrase, seen: Sequence[Detection]) -> list[Detection]:
    """Finds whose label names the subject, its place left aside."""
    labels = [MapObject(id="?" * (i + 1), description=d.label, x_m=0.0, y_m=0.0) for i, d in enumerate(seen)]
    whole = ground_phrase(subject, labels)
    if whole.outcome == "none":
        noun = noun_phrase(subject)
        core = tuple(word for word in subject[: len(noun.core) + 1] if word.key in noun.core)
        whole = ground_phrase(core or subject, labels)
    if whole.outcome == "none":
        head = head_of(noun_phrase(subject).core)
        whole = ground_phrase(tokens(head), labels) if len(noun_phrase(subject).core) > 1 and head else whole
    return [] if whole.outcome == "none" else [seen[labels.index(item)] for item in whole.candidates]


def _where(detection: Detection, image: CameraImage) -> str:
    left, top, right, bottom = detection.box
    across = (left + right) / 2 / max(image.width, 1)
    down = (top + bottom) / 2 / max(image.height, 1)
    side = "on the left" if across < 1 / 3 else "on the right" if across > 2 / 3 else ""
    height = "at the top" if down < 1 / 5 else "at the bottom" if down > 4 / 5 else ""
    where = " ".join(part for part in (height, side) if part) or "in the middle"
    far = f", about {detection.distance_m:.1f} m away" if detection.distance_m is not None else ""
    return f"{where} of the picture{far}"


def _overview(seen: Sequence[Detection], image: CameraImage) -> str:
    if not seen:
        return "I can see nothing that I know."
    return whole_sentence(f"I can see {listing([f'{a(d.label)} {_where(d, image)}' for d in seen[:12]])}")
