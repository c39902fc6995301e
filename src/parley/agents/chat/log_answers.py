"""What the chat interface answers from the audit log: who sent a robot, who stopped it, what it did."""

from __future__ import annotations

from typing import Final

from parley.clock import Clock
from parley.errors import InvalidMessageError, TransportError, UnavailableError
from parley.gate.audit_answers import EFFECTS, answer_from_log, question_of
from parley.messages import topics
from parley.messages.audit import AuditEntry, AuditList, GetAudit
from parley.messages.chat import ChatInput
from parley.messages.ros import ChatRequest
from parley.messages.wire import decode, encode
from parley.transport.base import Transport

__all__ = ["log_answer"]

_TIMEOUT_S: Final = 5.0
_FAR_BACK: Final = 300
"""Entries of one kind that are looked through."""


async def log_answer(transport: Transport, clock: Clock, target: str, said: ChatInput) -> str | None:
    """The answer to a question about who wanted what; None if it is no such question.

    Args:
        transport: Where the log is asked.
        clock: Wall time.
        target: The robot that is spoken to.
        said: The message.
    """
    asked = question_of(said.message)
    if asked is None:
        return None
    found: list[AuditEntry] = []
    try:
        for effect in EFFECTS[asked.about]:
            query = ChatRequest(encode(GetAudit(effect=effect, limit=_FAR_BACK)))
            answer = await transport.call(topics.GET_AUDIT, query, timeout_s=_TIMEOUT_S)
            found.extend(decode(AuditList, answer.response).entries)
    except UnavailableError:
        found = []  # nobody keeps a log: it is not known
    except (TransportError, InvalidMessageError):
        return "My log does not answer at the moment. Please ask again."
    newest = sorted(found, key=lambda entry: -entry.number)
    return answer_from_log(said.message, target, newest, now_unix_ms=clock.unix_ms(), asker=said.who.name)
