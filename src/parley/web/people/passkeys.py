"""Passkeys: what the browser is asked, and whether its answer holds. The work is `webauthn`'s."""

from __future__ import annotations

import json
import secrets
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final
from urllib.parse import urlsplit

from webauthn import (
    base64url_to_bytes,
    generate_authentication_options,
    generate_registration_options,
    options_to_json,
    verify_authentication_response,
    verify_registration_response,
)
from webauthn.helpers import bytes_to_base64url
from webauthn.helpers.exceptions import WebAuthnException
from webauthn.helpers.structs import (
    AuthenticatorSelectionCriteria,
    PublicKeyCredentialDescriptor,
    ResidentKeyRequirement,
    UserVerificationRequirement,
)

from parley.web.people.records import Passkey

__all__ = ["Ceremonies", "PasskeyRefusedError", "can_have_passkeys"]

CHALLENGE_S: Final = 300.0
MAX_OPEN: Final = 1000


class PasskeyRefusedError(Exception):
    """What the browser answered does not hold."""


def can_have_passkeys(origin: str) -> bool:
    """Whether browsers have passkeys at an address: it has a name, and HTTPS unless it is this machine."""
    parts = urlsplit(origin)
    host = parts.hostname or ""
    is_number = ":" in host or host.replace(".", "").isdecimal()
    return not is_number and (parts.scheme == "https" or host == "localhost")


@dataclass(frozen=True, slots=True)
class _Asked:
    challenge: bytes
    whose: str
    until_s: float


class Ceremonies:
    """What browsers were asked and have not answered yet; each question counts once."""

    def __init__(self) -> None:
        self._asked: dict[str, _Asked] = {}

    def ask_new(
        self, origin: str, person: str, name: str, known: Sequence[Passkey], now_s: float
    ) -> tuple[str, dict[str, Any]]:
        """Ask for a new passkey.

        Args:
            origin: Address of the page.
            person: Key of the account.
            name: As it is shown.
            known: Passkeys that they have.
            now_s: Now.

        Returns:
            Name of the question, and what the browser's own interface takes.
        """
        options = generate_registration_options(
            rp_id=_host(origin),
            rp_name="Parley",
            user_name=name,
            user_id=person.encode()[:64],
            exclude_credentials=[
                PublicKeyCredentialDescriptor(id=base64url_to_bytes(passkey.id)) for passkey in known
            ],
            authenticator_selection=AuthenticatorSelectionCriteria(
                resident_key=ResidentKeyRequirement.REQUIRED,
                user_verification=UserVerificationRequirement.REQUIRED,
            ),
        )
        return self._keep(options.challenge, person, now_s), json.loads(options_to_json(options))

    def take_new(
        self, key: str, credential: dict[str, Any], origin: str, person: str, now_s: float
    ) -> tuple[str, bytes, int]:
        """The new passkey: id, public key, count.

        Raises:
            PasskeyRefusedError: It does not hold.
        """
        challenge = self._take(key, person, now_s)
        try:
            made = verify_registration_response(
                credential=credential,
                expected_challenge=challenge,
                expected_rp_id=_host(origin),
                expected_origin=origin,
                require_user_verification=True,
            )
        except (WebAuthnException, ValueError, KeyError, TypeError) as error:
            raise PasskeyRefusedError(str(error)) from error
        return bytes_to_base64url(made.credential_id), made.credential_public_key, made.sign_count

    def ask_known(self, origin: str, now_s: float) -> tuple[str, dict[str, Any]]:
        """Ask for any passkey that the browser has for this address."""
        options = generate_authentication_options(
            rp_id=_host(origin), user_verification=UserVerificationRequirement.REQUIRED
        )
        return self._keep(options.challenge, "", now_s), json.loads(options_to_json(options))

    def take_known(
        self, key: str, credential: dict[str, Any], origin: str, passkey: Passkey, now_s: float
    ) -> int:
        """Whether it is that passkey; its new count.

        Raises:
            PasskeyRefusedError: It is not.
        """
        challenge = self._take(key, "", now_s)
        try:
            return verify_authentication_response(
                credential=credential,
                expected_challenge=challenge,
                expected_rp_id=_host(origin),
                expected_origin=origin,
                credential_public_key=passkey.public_key,
                credential_current_sign_count=passkey.count,
                require_user_verification=True,
            ).new_sign_count
        except (WebAuthnException, ValueError, KeyError, TypeError) as error:
            raise PasskeyRefusedError(str(error)) from error

    def _keep(self, challenge: bytes, whose: str, now_s: float) -> str:
        key = secrets.token_urlsafe(16)
        self._asked[key] = _Asked(challenge, whose, now_s + CHALLENGE_S)
        if len(self._asked) > MAX_OPEN:
            del self._asked[next(iter(self._asked))]
        return key

    def _take(self, key: str, whose: str, now_s: float) -> bytes:
        asked = self._asked.pop(key, None)
        if asked is None or asked.whose != whose or now_s >= asked.until_s:
            raise PasskeyRefusedError("that was not asked, or too long ago")
        return asked.challenge


def _host(origin: str) -> str:
    return urlsplit(origin).hostname or ""
