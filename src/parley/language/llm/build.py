"""A language engine from the settings. The libraries for models are loaded only when a model is asked for."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from parley.clock import Clock, WallClock
from parley.config import ModelSettings
from parley.extras import model_extra, needs
from parley.language.base import Language
from parley.language.llm.guard import Budget
from parley.language.llm.reading import PlanCheck
from parley.language.llm.usage import Usage

if TYPE_CHECKING:
    from parley.language.builtin.engine import BuiltinLanguage
    from parley.language.llm.engine import LlmLanguage

__all__ = ["build_language"]

_AUTO = "auto"
_BUILTIN = "builtin"
_REPLAY = "replay:"


def build_language(
    names: Sequence[str],
    settings: ModelSettings,
    *,
    check: PlanCheck,
    clock: Clock | None = None,
    usage: Usage | None = None,
    within_s: float | None = None,
) -> Language:
    """The engine that `names` says, the next behind the one before.

    Args:
        names: `builtin`, `provider:model`, `provider:model@address` or `replay:file`; the
            usual one first. `auto:` before a model: the built-in engine where it is certain (`auto` alone:
            with the next model).
        settings: How models are asked.
        check: Whether a plan can be carried out.
        clock: Wall time; None: this machine's.
        usage: Adds up what the models take; None: each its own.
        within_s: Wall time in which all models together have to answer; None: each has its own.

    Raises:
        ConfigError: A name is not understood, a library or a key is missing, a file cannot be read.
    """
    both, names = _split(names)
    if names[0] == _BUILTIN:
        return _builtin()
    with needs(model_extra(names[0])):
        from parley.language.llm.auto import AutoLanguage
        from parley.language.llm.chain import ChainLanguage

    clock = clock or WallClock()
    settings = _shared(settings, len({*names} - {_BUILTIN}), within_s)
    budget = Budget(clock, max_tokens=settings.max_tokens_per_hour, max_usd=settings.max_usd_per_hour)
    engines = [
        _builtin()
        if name == _BUILTIN
        else _model(name, settings, first=not number, check=check, clock=clock, usage=usage, budget=budget)
        for number, name in enumerate(dict.fromkeys(names))
    ]
    if both:
        own = _builtin()
        return AutoLanguage(own, ChainLanguage([*engines, own]))
    return ChainLanguage(engines) if len(engines) > 1 else engines[0]


def _split(names: Sequence[str]) -> tuple[bool, list[str]]:
    """Whether the built-in engine is asked first, and who besides."""
    first, *others = names
    models = [name for name in others if name != _BUILTIN]
    if first == _AUTO:
        return bool(models), models or [_BUILTIN]
    if first.startswith(f"{_AUTO}:"):
        return True, [first.removeprefix(f"{_AUTO}:"), *models]
    return False, list(names)


def _builtin() -> BuiltinLanguage:
    """Loaded, with its weights, only where it is asked for."""
    from parley.language.builtin.engine import BuiltinLanguage

    return BuiltinLanguage()


def _shared(settings: ModelSettings, models: int, within_s: float | None) -> ModelSettings:
    """The settings with the time shared among so many models."""
    limit_s = settings.timeout_s if within_s is None else min(settings.timeout_s, within_s / models)
    memory_s = settings.memory_timeout_s / models
    return settings.model_copy(update={"timeout_s": limit_s, "memory_timeout_s": memory_s})


def _model(
    name: str,
    settings: ModelSettings,
    *,
    first: bool,
    check: PlanCheck,
    clock: Clock,
    usage: Usage | None,
    budget: Budget,
) -> LlmLanguage:
    from parley.language.llm.engine import LlmLanguage
    from parley.language.llm.models import ModelSpec, make_model, read_key
    from parley.language.llm.recording import Recorder, Redactor, replay_model

    replays = name.startswith(_REPLAY)
    key = read_key(settings.key_file) if first and not replays else ""
    redactor, marks = Redactor([key]), False
    if replays:
        model, shown = replay_model(Path(name.removeprefix(_REPLAY))), "replay"
    else:
        spec = ModelSpec.parse(name, settings.base_url if first else "")
        model, shown, marks = make_model(spec, key), spec.name, not spec.is_compatible
    recorder = Recorder(settings.record_file, redactor) if settings.record_file and not replays else None
    small = None
    if first and settings.small and not replays:
        alone = settings.model_copy(update={"small": "", "retries": 0})
        small = _model(
            settings.small, alone, first=False, check=check, clock=clock, usage=usage, budget=budget
        )
    return LlmLanguage(
        model,
        shown,
        settings,
        clock=clock,
        check=check,
        usage=usage,
        budget=budget,
        redactor=redactor,
        recorder=recorder,
        streams=not replays,
        marks=marks,
        small=small,
    )
