"""Understanding with a language model, of any provider or on a server of one's own (design section 5).

`engine` asks (pydantic-ai agents with typed answers), `answers` says what an answer looks like, `reading`
checks it before anybody uses it, `guard` keeps what fails or costs too much away, `chain` passes on to the
next engine, `recording` keeps exchanges and plays them again, `usage` counts. `build` makes one of them from
the settings, and only then are the libraries for models loaded. `scripted_server` plays a model over HTTP,
for tests and measuring.
"""

from parley.language.llm.build import build_language

__all__ = ["build_language"]
