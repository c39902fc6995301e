"""A small server with OpenAI's `POST /embeddings`, for tests and rehearsals: real HTTP, no model.

A text's vector counts its words, and words said to be alike count as one. That is enough to see whether what
is around a model works, and nothing to find memories with in earnest.
"""

from __future__ import annotations

import hashlib
import json
import threading
from collections.abc import Mapping
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from types import TracebackType
from typing import Any, Final, Self

from parley.memory.retrieval import words

__all__ = ["EmbeddingServer"]

_LENGTH: Final = 256
_MAX_BODY_BYTES: Final = 64 * 1024 * 1024


class EmbeddingServer:
    """Use as ``with``; serves on a free port of this machine in a thread of its own.

    Args:
        alike: Word -> the word it means the same as.
        key: If not empty, only requests with this bearer token are answered.
    """

    def __init__(self, alike: Mapping[str, str] | None = None, *, key: str = "") -> None:
        self.alike, self.key = dict(alike or {}), key
        self.status = 200
        """What the next requests are answered with."""
        self.pads = 0
        """So many spaces are sent before each answer."""
        self.refuses = ""
        """Requests with a text that holds this are answered with status 400."""
        self.asked: list[list[str]] = []
        """The texts of each request, in order."""
        self._server = ThreadingHTTPServer(("127.0.0.1", 0), _handler(self))
        self._server.daemon_threads = True
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.05,), daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()

    @property
    def address(self) -> str:
        """What a client is configured with."""
        return f"http://127.0.0.1:{self._server.server_address[1]}/v1"

    def answer(self, path: str, authorization: str, body: bytes) -> tuple[int, dict[str, Any]]:
        """The status and JSON answer to a request."""
        if path != "/v1/embeddings":
            return 404, {"error": {"message": "not found"}}
        if self.key and authorization != f"Bearer {self.key}":
            return 401, {"error": {"message": "wrong key"}}
        asked = json.loads(body)
        texts: list[str] = [asked["input"]] if isinstance(asked["input"], str) else asked["input"]
        self.asked.append(texts)
        if self.refuses and any(self.refuses in text for text in texts):
            return 400, {"error": {"message": "text refused"}}
        if self.status != 200:
            return self.status, {"error": {"message": "out of order"}}
        data = [
            {"object": "embedding", "index": i, "embedding": self._vector(t)} for i, t in enumerate(texts)
        ]
        return 200, {"object": "list", "model": asked.get("model"), "data": data}

    def _vector(self, text: str) -> list[float]:
        counts = [0.0] * _LENGTH
        for word in words(text):
            meant = self.alike.get(word, word)
            counts[int.from_bytes(hashlib.sha256(meant.encode()).digest()[:4], "big") % _LENGTH] += 1.0
        return counts


def _handler(server: EmbeddingServer) -> type[BaseHTTPRequestHandler]:
    class Handler(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            length = min(int(self.headers.get("Content-Length") or 0), _MAX_BODY_BYTES)
            body = self.rfile.read(length)
            status, answer = server.answer(self.path, self.headers.get("Authorization") or "", body)
            content = b" " * server.pads + json.dumps(answer).encode()
            self.send_response(status)
            self.send_header("Content-Type", "application/json")
            self.send_header("Content-Length", str(len(content)))
            self.end_headers()
            self.wfile.write(content)

        def log_message(self, format: str, *args: Any) -> None:
            """Nothing: a test has its own output."""

    return Handler
