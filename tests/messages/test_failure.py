"""The last words of a failing action: ours, the thesis's, or any text at all."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from parley.errors import ActionFailure, FailureCode
from parley.messages.failure import FailureReport


@pytest.mark.parametrize("code", FailureCode)
def test_a_failure_survives_as_text_with_its_code_and_facts(code: FailureCode) -> None:
    failure = ActionFailure(code, "It did not work.", {"candidates": [{"id": "box_1"}]})
    report = FailureReport.parse(FailureReport.of(failure).to_text())
    assert (report.code, report.message, report.details) == (code, "It did not work.", failure.details)


def test_the_key_that_other_programs_misspell_is_the_one_written() -> None:
    report = FailureReport(message="m", process_instructions="ask", process_data_text="t")
    assert json.loads(report.to_text())["process_instrutions"] == "ask"
    assert FailureReport.parse(report.to_text()) == report


def test_a_report_of_the_thesis_without_our_keys_is_read() -> None:
    report = FailureReport.parse('{"message": "no way", "process_instrutions": "x", "other": 1}')
    assert (report.message, report.process_instructions, report.code) == ("no way", "x", FailureCode.INTERNAL)


@pytest.mark.parametrize(
    ("written", "code"),
    [
        ("Timed out", FailureCode.TIMED_OUT),
        ("ATTENTION_NEEDED", FailureCode.ATTENTION),
        ("no-match", FailureCode.NO_MATCH),
        ("odd", FailureCode.INTERNAL),
        (7, FailureCode.INTERNAL),
    ],
)
def test_code_of_another_program_is_read_if_it_is_ours_and_else_passed_over(
    written: object, code: FailureCode
) -> None:
    report = FailureReport.parse(json.dumps({"message": "m", "code": written, "process_instrutions": "x"}))
    assert (report.code, report.message, report.process_instructions) == (code, "m", "x")


@pytest.mark.parametrize("text", ["plain words", "", "[1]", '{"message": 3}', "[" * 100_000])
def test_anything_else_is_the_message_itself(text: str) -> None:
    assert FailureReport.parse(text) == FailureReport(message=text)


@given(st.text())
def test_no_text_is_too_strange(text: str) -> None:
    assert FailureReport.parse(text).message is not None
