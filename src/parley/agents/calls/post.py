"""Ways out of the house: a webhook, an e-mail. Each blocks, and is called in a thread."""

from __future__ import annotations

import http.client
import json
import smtplib
import ssl
import urllib.error
import urllib.request
from collections.abc import Callable
from dataclasses import asdict, dataclass
from email.message import EmailMessage
from pathlib import Path
from typing import Final

from parley.config import CallSettings, EmailSettings
from parley.errors import ConfigError, UnavailableError

__all__ = ["Note", "Send", "sender"]

TIMEOUT_S: Final = 10.0
_SUBJECT_CHARS: Final = 120


@dataclass(frozen=True, slots=True)
class Note:
    """What somebody is told."""

    text: str
    robot: str
    waited_s: int
    link: str = ""
    """Where it is answered."""


Send = Callable[[Note], None]
"""Tells somebody, and returns when they are told.

Raises:
    UnavailableError: It does not get through; says why.
"""


def sender(settings: CallSettings) -> Send:
    """The way out that the settings describe.

    Raises:
        ConfigError: A file with a secret cannot be read.
    """
    if settings.email is not None:
        return _mailer(settings.email)
    address = settings.webhook or _secret(settings.webhook_file, "calls.webhook_file")
    return lambda note: _post(address, note)


def _post(address: str, note: Note) -> None:
    headers = {"Content-Type": "application/json"}
    try:
        request = urllib.request.Request(address, json.dumps(asdict(note)).encode(), headers, method="POST")
        with urllib.request.urlopen(request, timeout=TIMEOUT_S):
            return
    except urllib.error.HTTPError as error:
        with error:
            raise UnavailableError(f"the webhook answers with status {error.code}") from error
    except (OSError, ValueError, http.client.HTTPException) as error:
        raise UnavailableError(f"the webhook cannot be reached: {type(error).__name__}") from error


def _mailer(settings: EmailSettings) -> Send:
    password = _secret(settings.password_file, "calls.email.password_file") if settings.user else ""

    def send(note: Note) -> None:
        mail = EmailMessage()
        mail["From"], mail["To"] = settings.sender, ", ".join(settings.to)
        mail["Subject"] = " ".join(note.text.split())[:_SUBJECT_CHARS]
        mail.set_content("\n\n".join(filter(None, (note.text, note.link))))
        try:
            with _server(settings) as server:
                if settings.user:
                    server.login(settings.user, password)
                server.send_message(mail)
        except (OSError, smtplib.SMTPException) as error:
            raise UnavailableError(f"the e-mail cannot be sent: {type(error).__name__}") from error

    return send


def _server(settings: EmailSettings) -> smtplib.SMTP:
    secure = ssl.create_default_context()
    if settings.tls == "tls":
        return smtplib.SMTP_SSL(settings.host, settings.port, timeout=TIMEOUT_S, context=secure)
    server = smtplib.SMTP(settings.host, settings.port, timeout=TIMEOUT_S)
    try:
        if settings.tls == "starttls":
            server.starttls(context=secure)
    except BaseException:
        server.close()
        raise
    return server


def _secret(path: Path | None, name: str) -> str:
    if path is None:
        raise ConfigError(f"{name} is missing")
    try:
        return path.read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"{name}: {path} cannot be read") from error
