"""One round as one HTML file: no other file, no script, no network. Pure."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from datetime import datetime
from html import escape
from typing import Final

from parley.sentences import SpokenLanguage, in_language, sentence
from parley.web.models import ChatEntry, RoundView
from parley.web.store import KeptPicture

__all__ = ["round_file"]

_STYLE: Final = (
    "body{font:16px/1.5 system-ui,sans-serif;max-width:46rem;margin:2rem auto;padding:0 1rem}"
    "dt{font-weight:600}dd{margin:0 0 .6rem}img{max-width:100%;margin:.5rem 0}time{color:#555}"
)
_STATES: Final = {
    "running": "It goes on.", "done": "It was done.", "partly": "It was done in part.",
    "failed": "It was not got done.", "ended": "It was ended before it was done.",
    "unrecorded": "Its end was not recorded.",
}  # fmt: skip


def round_file(
    told: RoundView, said: Sequence[ChatEntry], pictures: Sequence[KeptPicture], language: SpokenLanguage
) -> str:
    """The file.

    Args:
        told: The round.
        said: What was said meanwhile, oldest first.
        pictures: What the robot took pictures of.
        language: Of our own words.
    """

    def ours(text: str) -> str:
        return escape(in_language(text, language))

    def speaker(entry: ChatEntry) -> str:
        return escape(", ".join(entry.targets) if entry.who == "robot" else entry.author) or ours("Somebody")

    def words(entry: ChatEntry) -> str:
        return ours(entry.message) if entry.who == "robot" else escape(entry.message)

    day = datetime.fromtimestamp(told.unix_ms / 1000).astimezone()
    title = escape(told.words or ", ".join(told.steps) or told.robot)
    facts = [
        (sentence("Robot"), escape(told.robot)),
        (sentence("Who wanted it"), escape(told.by)),
        (sentence("Who said yes"), escape(told.approved_by)),
        (sentence("Began"), f"{day:%Y-%m-%d %H:%M:%S}"),
        (sentence("Ended"), _clock(told.ended_unix_ms)),
        (sentence("How it ended"), f"{ours(sentence(_STATES[told.state]))} {ours(told.reason)}".strip()),
        (sentence("Found"), "<br>".join(escape(text) for text in told.found)),
        (sentence("Left out"), "; ".join(ours(step) for step in told.left)),
    ]
    rows = "".join(f"<dt>{ours(name)}</dt><dd>{value}</dd>" for name, value in facts if value)
    steps = "".join(f"<li>{ours(step)}</li>" for step in told.steps)
    lines = "".join(
        f"<p><time>{_clock(entry.unix_ms)}</time> <b>{speaker(entry)}</b>: {words(entry)}</p>"
        for entry in said
        if entry.message
    )
    shown = "".join(
        f'<img alt="{ours(sentence("Picture"))} {number}" src="data:{picture.media_type};base64,'
        f'{base64.b64encode(picture.data).decode("ascii")}">'
        for number, picture in enumerate(pictures, 1)
    )
    return (
        f'<!doctype html><html lang="{language}"><meta charset="utf-8">'
        f'<meta name="viewport" content="width=device-width"><title>{title}</title><style>{_STYLE}</style>'
        f"<main><h1>{title}</h1><dl>{rows}</dl>"
        f"{_part(ours(sentence('Steps')), steps and f'<ol>{steps}</ol>')}"
        f"{_part(ours(sentence('What was said')), lines)}"
        f"{_part(ours(sentence('Pictures')), shown)}</main></html>\n"
    )


def _part(title: str, body: str) -> str:
    return f"<h2>{title}</h2>{body}" if body else ""


def _clock(unix_ms: int) -> str:
    return f"{datetime.fromtimestamp(unix_ms / 1000).astimezone():%H:%M:%S}" if unix_ms else ""
