"""`rules.yaml`: reading, writing back, keeping.

Reading says what is wrong with file, line and field. Writing back replaces only what changed: the text of all
other rules stays as people wrote it, with their comments.
"""

from __future__ import annotations

import asyncio
import textwrap
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Final

import structlog
import yaml

from parley.errors import ConfigError
from parley.files import read_text, replace_text, validated_yaml
from parley.gate.book import RuleBook
from parley.messages.principal import Principal
from parley.messages.rules import Rule, RuleSet

__all__ = ["FILE_NAME", "RuleChanged", "RuleKeeper", "read_rules", "rule_yaml", "with_rules"]

FILE_NAME: Final = "rules.yaml"

RuleChanged = Callable[[Rule, bool, Principal | None], None]
"""A rule, whether it was dropped, and by whom."""

_ASKED: Final = ".asked.yaml"
log = structlog.get_logger(__name__)

_HEAD: Final = "# What robots may do here; `parley rules check` looks for mistakes.\nschema: 1\n"


def read_rules(text: str, file: str = FILE_NAME) -> RuleSet:
    """The rules in a text.

    Raises:
        FileFormatError: Names the file, the line and the field.
    """
    return validated_yaml(RuleSet, text, file)


def rule_yaml(rule: Rule) -> str:
    """One rule as it stands in the file."""
    body = rule.model_dump(mode="json", by_alias=True, exclude_defaults=True)
    body = {"id": rule.id, "kind": rule.kind} | body
    text = yaml.safe_dump(body, sort_keys=False, allow_unicode=True, default_flow_style=None, width=1000)
    lines = text.splitlines()
    return "".join(f"{'- ' if number == 0 else '  '}{line}\n" for number, line in enumerate(lines))


def with_rules(text: str, before: RuleSet, after: RuleSet) -> str:
    """A file's text with other rules; what did not change stays as it was written.

    Args:
        text: As it stands; empty for a new file.
        before: What is in it.
        after: What is to be in it.
    """
    head, pieces = _pieces(text)
    kept = dict(zip(before.rules, pieces, strict=True)) if len(pieces) == len(before.rules) else {}
    body = "".join(kept.get(rule) or rule_yaml(rule) for rule in after.rules)
    return f"{head}rules:\n{body}" if after.rules else f"{head}rules: []\n"


def _pieces(text: str) -> tuple[str, list[str]]:
    """What stands before the list of rules, and the text of each rule with the comments above it."""
    root = yaml.compose(text, Loader=yaml.SafeLoader) if text.strip() else None
    if not isinstance(root, yaml.MappingNode):
        return _HEAD, []
    found = next(((key, value) for key, value in root.value if key.value == "rules"), None)
    lines = text.splitlines(keepends=True)
    if lines and not lines[-1].endswith("\n"):
        lines[-1] += "\n"
    if found is None:
        return "".join(lines), []
    key, listed = found
    rest = [k.start_mark.line for k, _ in root.value if k.start_mark.line > key.start_mark.line]
    if rest:  # something stands behind the rules: it goes before them
        end = _with_comments(lines, rest[0])
        head = lines[: key.start_mark.line] + lines[end:]
    else:
        end, head = len(lines), lines[: key.start_mark.line]
    if not isinstance(listed, yaml.SequenceNode) or listed.flow_style:
        return "".join(head), []
    starts = [_with_comments(lines, item.start_mark.line) for item in listed.value] + [end]
    pieces = ["".join(lines[a:b]) for a, b in pairwise(starts)]
    return "".join(head), [textwrap.dedent(piece) for piece in pieces]


def _with_comments(lines: list[str], line: int) -> int:
    """The first line of the comments right above a line."""
    while line > 0 and lines[line - 1].lstrip().startswith("#"):
        line -= 1
    return line


@dataclass(frozen=True, slots=True)
class _Written:
    text: str
    rules: RuleSet


class RuleKeeper:
    """Keeps the rules of a book in a file; without one they hold while the process runs.

    Args:
        book: Where the rules hold.
        path: The file; it need not be there yet.

    Raises:
        FileFormatError: The file cannot be read; names the line and the field.
        ConfigError: It names a time zone that is not known.
    """

    def __init__(self, book: RuleBook, path: Path | None = None) -> None:
        self._book, self._path = book, path
        self._saving = asyncio.Lock()
        self._watchers: list[RuleChanged] = []
        self._written = _Written("", RuleSet())
        if path is not None and path.exists():
            text = read_text(path)
            self._written = _Written(text, read_rules(text, path.name))
            book.replace(self._written.rules)
        self._asked = path.with_suffix(_ASKED) if path is not None else None
        self._asking = _asked_before(self._asked)
        self.left_over: Sequence[Rule] = self._asking.rules.rules
        """What an earlier process asked about when it ended, and was not told."""

    @property
    def path(self) -> Path | None:
        """Where the rules are kept."""
        return self._path

    async def note_asked(self, rules: Sequence[Rule]) -> None:
        """Write down what is asked about, so that the next process can say that it is no rule."""
        if self._asked is None or tuple(rules) == self._asking.rules.rules:
            return
        after = RuleSet(rules=tuple(rules))
        text = with_rules("", RuleSet(), after)
        try:
            await asyncio.to_thread(_write, self._asked, self._asking.text, text)
        except ConfigError as error:  # whoever told it is asked all the same
            log.warning("what is asked about is not written down", problem=str(error))
            return
        self._asking = _Written(text, after)

    def on_change(self, told: RuleChanged) -> None:
        """Have `told` called with each rule that a person lets hold or drops, once it is on the disk."""
        self._watchers.append(told)

    async def put(self, rule: Rule, by: Principal | None) -> None:
        """Add a rule, or replace the one of its id; it is on the disk when this returns.

        Raises:
            ConfigError: The file cannot be written, or was changed by somebody else.
        """
        async with self._saving:
            rules, known = list(self._book.rules.rules), self._book.rules.get(rule.id)
            if known is None:
                rules.append(rule)
            else:
                rules[rules.index(known)] = rule
            await self._save(rules)
        self._tell(rule, False, by)

    async def drop(self, rule_id: str, by: Principal | None) -> Rule | None:
        """Remove a rule; None if there is none of that id.

        Raises:
            ConfigError: As `put`.
        """
        async with self._saving:
            known = self._book.rules.get(rule_id)
            if known is not None:
                await self._save([rule for rule in self._book.rules.rules if rule is not known])
        if known is not None:
            self._tell(known, True, by)
        return known

    def _tell(self, rule: Rule, dropped: bool, by: Principal | None) -> None:
        for told in self._watchers:
            told(rule, dropped, by)

    async def _save(self, rules: list[Rule]) -> None:
        after = self._book.rules.model_copy(update={"rules": tuple(rules)})
        if self._path is not None:
            text = with_rules(self._written.text, self._written.rules, after)
            await asyncio.to_thread(_write, self._path, self._written.text, text)
            self._written = _Written(text, after)
        self._book.replace(after)


def _asked_before(path: Path | None) -> _Written:
    """What is written down there; nothing if it is not there or damaged: it only makes a sentence."""
    try:
        text = path.read_text(encoding="utf-8") if path is not None and path.exists() else ""
        return _Written(text, read_rules(text) if text else RuleSet())
    except (OSError, UnicodeDecodeError, ConfigError) as error:
        log.warning("what was asked about cannot be read", problem=str(error))
        return _Written("", RuleSet())


def _write(path: Path, before: str, text: str) -> None:
    """Replace a file's text as a whole or not at all.

    Raises:
        ConfigError: It is not what was read, or cannot be written.
    """
    try:
        now = path.read_text(encoding="utf-8") if path.exists() else ""
        if now != before:
            raise ConfigError(f"{path.name} was changed by somebody else meanwhile: restart to read it")
        replace_text(path, text)
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path.name} cannot be written: {error}") from error
