"""What texts mean, as numbers, from any server with OpenAI's `POST /embeddings` (one's own or a paid one)."""

from __future__ import annotations

import asyncio
import http.client
import json
import os
import urllib.error
import urllib.request
from collections.abc import Callable, Sequence
from typing import Any, Final, NoReturn

import numpy as np

from parley.config import EmbeddingSettings
from parley.errors import ConfigError, LanguageError
from parley.memory.vectors import Vectors

__all__ = ["KEY_VARIABLE", "Embedder", "RefusedTextError", "configured_embedder"]

KEY_VARIABLE: Final = "PARLEY_EMBEDDINGS_KEY"
"""Environment variable with the key."""

_MAX_TEXT_BYTES: Final = 400_000
"""Of the answer for one text: more than 16,000 numbers."""
_PIECE_BYTES: Final = 64 * 1024
_REFUSALS: Final = frozenset({400, 413, 422})


class RefusedTextError(LanguageError):
    """The server is there, but will not have these texts."""


class _NoRedirect(urllib.request.HTTPRedirectHandler):
    """A redirect would carry the key to an address that nobody configured."""

    def redirect_request(self, *_: Any) -> None:
        return None


class Embedder:
    """Asks one model on one server.

    Args:
        base_url: Address up to and without ``/embeddings``, e.g. ``http://localhost:11434/v1``.
        model: The model's name there.
        key: Sent as a bearer token if not empty; never logged and in no error.
        timeout_s: Wall time an answer may take.

    Raises:
        ConfigError: The address is none of http or https.
    """

    def __init__(self, base_url: str, model: str, *, key: str = "", timeout_s: float = 5.0) -> None:
        if not base_url.startswith(("http://", "https://")):
            raise ConfigError(f"embeddings.url: {base_url!r} is no http or https address")
        if not key.isascii() or any(char.isspace() for char in key):
            raise ConfigError("the key for embeddings holds characters that no key has")
        self.model = model
        self._url = base_url.rstrip("/") + "/embeddings"
        self._key, self._timeout_s = key, timeout_s
        self._opener = urllib.request.build_opener(_NoRedirect)

    async def embed(self, texts: Sequence[str]) -> Vectors:
        """One vector per text.

        Raises:
            RefusedTextError: The server refuses these texts.
            LanguageError: It does not answer in time, or not as it should.
        """
        try:
            async with asyncio.timeout(self._timeout_s):
                # The thread ends by itself, too: a server that drips would else keep one thread per question.
                now_s = asyncio.get_running_loop().time
                end_s = now_s() + self._timeout_s
                answer = await asyncio.to_thread(self._post, list(texts), lambda: now_s() > end_s)
        except TimeoutError as error:
            raise LanguageError("the embedding server did not answer in time") from error
        return _read(answer, len(texts))

    def _post(self, texts: list[str], too_late: Callable[[], bool]) -> bytes:
        headers = {"Content-Type": "application/json", "Accept": "application/json"}
        if self._key:
            headers["Authorization"] = f"Bearer {self._key}"
        body = json.dumps({"model": self.model, "input": texts, "encoding_format": "float"}).encode()
        request = urllib.request.Request(self._url, data=body, headers=headers, method="POST")
        try:
            with self._opener.open(request, timeout=self._timeout_s) as response:
                return _content(response, _MAX_TEXT_BYTES * (len(texts) + 1), too_late)
        except urllib.error.HTTPError as error:
            with error:
                _refused(error.code)
        except (OSError, http.client.HTTPException) as error:
            raise LanguageError(f"the embedding server cannot be reached: {type(error).__name__}") from error


def _content(response: http.client.HTTPResponse, limit: int, too_late: Callable[[], bool]) -> bytes:
    content = bytearray()
    while piece := response.read1(_PIECE_BYTES):
        content += piece
        if len(content) > limit:
            raise LanguageError("the embedding server's answer is too long")
        if too_late():
            raise TimeoutError
    return bytes(content)


def configured_embedder(settings: EmbeddingSettings) -> Embedder:
    """The embedder that the settings describe.

    Raises:
        ConfigError: The address or the key cannot be used.
    """
    key = os.environ.get(KEY_VARIABLE, "")
    if settings.key_file is not None:
        try:
            key = settings.key_file.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise ConfigError(f"embeddings.key_file: {settings.key_file} cannot be read") from error
    return Embedder(settings.url, settings.model, key=key.strip(), timeout_s=settings.timeout_s)


def _refused(status: int) -> NoReturn:
    if status in _REFUSALS:
        raise RefusedTextError(f"the embedding server refuses a text (status {status})")
    raise LanguageError(f"the embedding server answers with status {status}")


def _read(answer: bytes, count: int) -> Vectors:
    try:
        items = sorted(json.loads(answer)["data"], key=lambda item: item.get("index", 0))
        rows = np.asarray([item["embedding"] for item in items], dtype=np.float32)
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise LanguageError("the embedding server's answer cannot be read") from error
    if rows.ndim != 2 or rows.shape[0] != count or rows.shape[1] == 0 or not np.isfinite(rows).all():
        raise LanguageError("the embedding server's answer does not fit the question")
    lengths = np.linalg.norm(rows, axis=1, keepdims=True)
    return np.asarray(rows / np.where(lengths == 0, 1, lengths), np.float32)
