"""Every statement of the specification is held by a test that names it; see `pytest --conformance`."""

from __future__ import annotations

import itertools

from tests.conformance_ids import DEFECTS, IDS, SECTIONS
from tests.conftest import holders

EXPECTED_NUMBERS = {
    "D": 37,
    "W": 11,
    "P": 21,
}


def test_the_list_of_defects_is_whole() -> None:
    counted = itertools.chain.from_iterable(
        (f"{letter}{number}" for number in range(1, last + 1)) for letter, last in EXPECTED_NUMBERS.items()
    )
    assert [*DEFECTS] == [*counted]


def test_every_statement_has_a_test() -> None:
    found = holders()
    assert [name for name in IDS if name not in found] == []


def test_no_test_names_a_statement_of_no_section() -> None:
    sections = {name.split(".")[0].removesuffix("-better") for name in SECTIONS} | {"13", "16", "17"}
    unknown = {
        name
        for name in holders()
        if name not in IDS and name.split(".")[0].removesuffix("-better") not in sections
    }
    assert unknown == set()
