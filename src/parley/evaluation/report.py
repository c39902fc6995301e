"""What an evaluation gave, for people and for programs; blind cases that fail appear only if asked for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from parley.evaluation.running import Outcome
from parley.evaluation.scores import BackendScore, Share

__all__ = ["failing", "json_report", "markdown_report"]


def failing(outcomes: Sequence[Outcome], *, reveal: bool) -> list[Outcome]:
    """The wrong ones that may be shown."""
    return [outcome for outcome in outcomes if not outcome.right and (reveal or not outcome.case.blind)]


def json_report(
    set_name: str, scores: Sequence[BackendScore], outcomes: Sequence[Sequence[Outcome]], *, reveal: bool
) -> dict[str, Any]:
    """The report for programs: `outcomes` are those of each score, in the same order."""
    return {
        "set": set_name,
        "backends": [
            one.model_dump() | {"failing": [_failing_json(o) for o in failing(mine, reveal=reveal)]}
            for one, mine in zip(scores, outcomes, strict=True)
        ],
    }


def _failing_json(outcome: Outcome) -> dict[str, Any]:
    case = outcome.case
    return {"part": case.part, "case": case.id, "problems": list(outcome.problems)}


def markdown_report(
    set_name: str, scores: Sequence[BackendScore], outcomes: Sequence[Sequence[Outcome]], *, reveal: bool
) -> str:
    """The report for people, engines side by side."""
    lines = [f"# Evaluation on `{set_name}`", ""]
    lines += _row(["", *(f"`{one.language}`" for one in scores)])
    lines += _row(["---", *("---" for _ in scores)])
    lines += _row(["**right**", *(f"**{_shown(one.accuracy)}**" for one in scores)])
    lines += _row(["wrong deeds", *(_shown(one.wrong_deeds) for one in scores)])
    lines += _row(["executable plans", *(_shown(one.executable) for one in scores)])
    lines += _row(["latency p50 / p99", *(_latency(one) for one in scores)])
    lines += _row(["tokens in / out", *(_tokens(one) for one in scores)])
    lines += _row(["cost", *(_cost(one) for one in scores)])
    for one in scores:
        if one.engines:
            lines += ["", f"## Who answered: `{one.language}`", ""]
            lines += [*_row(["engine", "answered", "right", "wrong deeds"]), *_row(["---"] * 4)]
        for name, part in one.engines.items():
            lines += _row([name, *map(_shown, (part.answered, part.right, part.wrong_deeds))])
    for title, groups in (("parts", [s.parts for s in scores]), ("phenomena", [s.phenomena for s in scores])):
        lines += ["", f"## {title.capitalize()}", ""]
        lines += _row([title, *(f"`{one.language}`" for one in scores)])
        lines += _row(["---", *("---" for _ in scores)])
        for name in groups[0]:
            lines += _row([name, *(_shown(group[name]) for group in groups)])
    for one, mine in zip(scores, outcomes, strict=True):
        shown = failing(mine, reveal=reveal)
        if shown:
            lines += ["", f"## Wrong: `{one.language}`", ""]
            for outcome in shown:
                lines += [f"- {outcome.case.part}: {outcome.case.id}"]
                lines += [f"  - {problem}" for problem in outcome.problems]
    return "\n".join(lines) + "\n"


def _row(cells: Sequence[str]) -> list[str]:
    return [f"| {' | '.join(cells)} |"]


def _shown(share: Share) -> str:
    if not share.count:
        return "-"
    part = share.right / share.count
    return f"{100 * part:.1f} % [{100 * share.low:.0f}, {100 * share.high:.0f}] ({share.right}/{share.count})"


def _latency(one: BackendScore) -> str:
    return "-" if one.p50_ms is None or one.p99_ms is None else f"{one.p50_ms:.1f} / {one.p99_ms:.1f} ms"


def _tokens(one: BackendScore) -> str:
    return "-" if one.usage is None else f"{one.usage['input_tokens']} / {one.usage['output_tokens']}"


def _cost(one: BackendScore) -> str:
    return "-" if one.usage is None else f"{one.usage['cost_usd']:.4f} USD"
