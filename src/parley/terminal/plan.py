"""How a robot's plan looks: steps in words, icons, the bar of the step that runs. Pure text, no terminal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from parley.messages.chat import ActionCall
from parley.messages.plain import in_words
from parley.messages.status import PlanStep, PlanUpdate
from parley.sentences import SpokenLanguage, in_language, sentence
from parley.terminal.lines import Fragments

__all__ = [
    "ICONS",
    "Progress",
    "bar",
    "call_in_words",
    "compare",
    "is_over",
    "lines_of",
    "plan_rows",
    "step_row",
]

ICONS = {
    "queued": "○",
    "running": "▶",
    "finished": "✓",
    "failed": "✗",
    "stopped": "■",
    "skipped": "»",
    "paused": "‖",
    "waiting": "?",
}
"""Step state -> one character."""

STATES: Final = {
    "queued": "to do",
    "running": "now",
    "finished": "done",
    "failed": "did not work",
    "stopped": "stopped",
    "skipped": "left out",
    "paused": "paused",
    "waiting": "waiting for you",
}
"""Step state in words."""
_STYLES = {"running": "class:now", "finished": "class:done", "failed": "class:bad", "waiting": "class:ask"}
_TELLING = ("running", "failed", "waiting", "paused", "stopped")
_MAX_LABEL_CHARS = 60


@dataclass(frozen=True, slots=True)
class Progress:
    """How far the step that runs is."""

    node: str
    fraction: float | None
    """0 to 1; None when that is not known."""
    text: str = ""


def _label(step: PlanStep) -> str:
    """A step in the words that code wrote of it, as it was approved and is told when it is over."""
    return step.label or call_in_words(step.action)


def call_in_words(call: ActionCall) -> str:
    """What an action is called and given, where nothing else was written of it."""
    given = [str(p.value) for p in call.input_parameters.values() if p.type == "string" and p.has_data]
    return f"{in_words(call.name)}: {', '.join(given)}" if given else in_words(call.name)


def bar(fraction: float, width: int = 16) -> str:
    """A progress bar of `width` characters with the percentage behind it."""
    fraction = min(max(fraction, 0.0), 1.0)
    full = round(fraction * width)
    return f"{'█' * full}{'░' * (width - full)} {round(fraction * 100)} %"


def step_row(
    step: PlanStep, language: SpokenLanguage, *, number: int = 0, progress: Progress | None = None
) -> str:
    """One step as a row of plain text; what is over has no number any more."""
    state = _progress_text(progress, language) or in_language(STATES[step.state], language)
    numbered = f"{number}. " if number and not is_over(step) else ""
    described = f" ({state})" if step.state != "queued" else ""
    return f"{ICONS[step.state]} {numbered}{in_language(_label(step), language)}{described}"


def is_over(step: PlanStep) -> bool:
    """Whether nothing more will come of a step."""
    return step.state in ("finished", "failed", "stopped", "skipped")


def lines_of(steps: Sequence[PlanStep]) -> list[PlanStep]:
    """The steps that are shown: until it begins, a step fares as the search that is made for it alone."""
    lines: list[PlanStep] = []
    search: PlanStep | None = None
    for step in steps:
        if step.for_next:
            search = step if step.state in _TELLING else search
            continue
        tells = search is not None and step.state == "queued"
        lines.append(step.model_copy(update={"state": search.state}) if search and tells else step)
        search = None
    return lines


def plan_rows(
    steps: Sequence[PlanStep],
    language: SpokenLanguage,
    progress: Progress | None = None,
    *,
    max_rows: int = 6,
) -> list[Fragments]:
    """The live view of a plan, at most `max_rows` rows around the first step that is not over."""
    steps = lines_of(steps)
    current = next((i for i, step in enumerate(steps) if not is_over(step)), len(steps))
    first = max(0, min(current - 1, len(steps) - max_rows))
    shown = steps[first : first + max_rows]
    width = max((len(_short(step, language)) for step in shown), default=0)
    rows = [_row(step, language, progress, width) for step in shown]
    hidden = len(steps) - first - len(shown)
    if hidden:
        more = in_language(sentence("and {count} more", count=hidden), language)
        rows.append([("class:dim", f"   {more}")])
    return rows


def compare(before: PlanUpdate | None, after: PlanUpdate) -> tuple[bool, list[PlanStep]]:
    """Whether `after` plans something that `before` did not, and which of the steps shown ended since.

    Steps that were never begun and will not be are no news: whoever cancelled them knows.
    """
    old = lines_of(before.steps) if before is not None else []
    new = lines_of(after.steps)
    old_keys = [_key(step) for step in old]
    new_keys = [_key(step) for step in new]
    same_graph = before is not None and before.graph_name == after.graph_name
    is_new = bool(new_keys) and not (same_graph and _contains(old_keys, new_keys))
    were_open = {(*_key(step), step.node): step.state for step in old if not is_over(step)}
    ended: list[PlanStep] = []
    for step in filter(is_over, new):
        was = were_open.get((*_key(step), step.node)) or were_open.get((*_key(step), ""))
        if was is not None and (was, step.state) != ("queued", "stopped"):
            ended.append(step)
    return is_new, ended


def _row(step: PlanStep, language: SpokenLanguage, progress: Progress | None, width: int) -> Fragments:
    style = _STYLES.get(step.state, "class:dim")
    mine = progress if progress and step.state == "running" and progress.node == step.node else None
    state = _progress_text(mine, language) or in_language(STATES[step.state], language)
    return [(style, f" {ICONS[step.state]} {_short(step, language):<{width}}  "), (style, state)]


def _progress_text(progress: Progress | None, language: SpokenLanguage) -> str:
    if progress is None:
        return ""
    parts = [bar(progress.fraction)] if progress.fraction is not None else []
    return "  ".join([*parts, in_language(progress.text, language)] if progress.text else parts)


def _short(step: PlanStep, language: SpokenLanguage) -> str:
    text = in_language(_label(step), language)
    return text if len(text) <= _MAX_LABEL_CHARS else f"{text[: _MAX_LABEL_CHARS - 1]}…"


def _key(step: PlanStep) -> tuple[str, str]:
    return step.action.name, _label(step)


def _contains(whole: Sequence[object], part: Sequence[object]) -> bool:
    """Whether `part` stands in `whole` as it is: a plan that only became shorter is no news."""
    return any(list(whole[i : i + len(part)]) == list(part) for i in range(len(whole) - len(part) + 1))
