"""The page itself: the built front end, or a plain one that says how to build it."""

from __future__ import annotations

import asyncio
import gzip
import html
import json
import mimetypes
from importlib import resources
from pathlib import Path
from typing import Final

from starlette.requests import Request
from starlette.responses import FileResponse, HTMLResponse, Response

from parley.errors import ConfigError
from parley.sentences import LANGUAGES, OWN_LANGUAGES
from parley.web.problems import WebProblem, problem_response

__all__ = ["Pages", "built_pages"]

NONCE_MARK: Final = "__CSP_NONCE__"
"""Where this stands in the page, the random word of the answer is put that its policy allows."""

_PLAIN = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Parley</title></head>
<body><h1>Parley</h1>
<p>The system is running, but its page is not built yet.
A released version brings it; from sources, <code>make page</code> builds it.</p>
<p>Until then: <code>parley demo --terminal</code> talks to the robots in a terminal.</p>
<p>Programs find the interface described at <a href="/api/openapi.json">/api/openapi.json</a>.</p>
</body></html>
"""


def built_pages() -> Path:
    """Where the built front end lies, if it was built."""
    return Path(str(resources.files("parley.web") / "static"))


class Pages:
    """Serves files of a folder; every other address is the page, which finds its way itself.

    Args:
        folder: The built front end.
        languages: Where its words in further languages are, ``fi.json``.

    Raises:
        ConfigError: One of those cannot be read.
    """

    def __init__(self, folder: Path, languages: Path | None = OWN_LANGUAGES) -> None:
        self._folder = folder.resolve()
        self._words = _words_in(languages) if languages else ""
        self._packed: dict[Path, bytes] = {}

    async def answer(self, request: Request) -> Response:
        """The file of a request."""
        path = request.path_params.get("path", "")
        file = self._file(path)
        if file is not None:
            # Names of built files hold a digest of what is in them.
            is_fixed = path.startswith("assets/")
            caching = "public, max-age=31536000, immutable" if is_fixed else "no-cache"
            if is_fixed and "gzip" in request.headers.get("Accept-Encoding", ""):
                return await self._packed_answer(file, caching)
            return FileResponse(file, headers={"Cache-Control": caching})
        if path.startswith(("api/", "assets/")):
            return problem_response(WebProblem(404, "There is nothing under this address."))
        return self._page(request)

    async def _packed_answer(self, file: Path, caching: str) -> Response:
        """A file that never changes under its name, packed once, so that a phone loads it fast."""
        if file not in self._packed:
            self._packed[file] = await asyncio.to_thread(lambda: gzip.compress(file.read_bytes()))
        return Response(
            self._packed[file],
            media_type=mimetypes.guess_type(file.name)[0],
            headers={
                "Cache-Control": caching,
                "Content-Encoding": "gzip",
                "Vary": "Accept-Encoding",
            },
        )

    def _file(self, path: str) -> Path | None:
        if path in ("", "index.html") or "\0" in path:
            return None
        try:
            file = (self._folder / path).resolve()
            return file if file.is_relative_to(self._folder) and file.is_file() else None
        except OSError:
            return None

    def _page(self, request: Request) -> Response:
        index = self._folder / "index.html"
        text = index.read_text(encoding="utf-8") if index.is_file() else _PLAIN
        nonce = request.scope.get("state", {}).get("nonce", "")
        text = text.replace(NONCE_MARK, html.escape(nonce)).replace("</head>", f"{self._words}</head>", 1)
        return HTMLResponse(text, headers={"Cache-Control": "no-cache"})


def _words_in(folder: Path) -> str:
    """The words of further languages as data in the page."""
    if not folder.is_dir():
        raise ConfigError(f"There is no folder {folder}, which PARLEY_LANGUAGES names.")
    files = {name: folder / f"{name}.json" for name in LANGUAGES}
    try:
        words = {name: json.loads(file.read_bytes()) for name, file in files.items() if file.is_file()}
    except (OSError, ValueError) as error:
        raise ConfigError(f"The words of the page in {folder} cannot be read: {error}") from error
    shown = json.dumps(words).replace("<", "\\u003c")
    return f'<script type="application/json" id="languages">{shown}</script>'
