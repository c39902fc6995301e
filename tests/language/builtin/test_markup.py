"""The markup of annotated sentences, and whether what lies there can be read."""

from __future__ import annotations

from importlib import resources

import pytest

from parley.errors import FileFormatError
from parley.language.builtin.markup import read_line, read_text

SENTENCES = resources.files("parley.language.builtin") / "training" / "sentences"


def test_a_sentence_is_read_with_its_frames_roles_and_owners() -> None:
    read = read_line(
        "told\t(T *Kim) {is:BELOC} (L at the *gate) , <order> {pick:TAKE} (T the red *crate on the ramp) "
        "{up:+} and {don't drop:!PUT} (T it) (L@2 in the *yard)"
    )
    take = read.triggers[1]
    assert [(trigger.frame, trigger.negated) for trigger in read.triggers] == [
        ("BELOC", False), ("TAKE", False), ("PUT", True),
    ]  # fmt: skip
    assert [read.words[number] for number in take.particles] == ["up"]
    assert [(span.role, read.words[span.head], span.owner) for span in read.roles] == [
        ("T", "Kim", 0), ("L", "gate", 0), ("T", "crate", 1), ("T", "it", 2), ("L", "yard", 1),
    ]  # fmt: skip
    assert (read.acts[0], read.acts[-1]) == ("told", "order")


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("go to the box", "a tab"),
        ("wish\tgo", "is no act"),
        ("order\t{go:FLY}", "is no frame"),
        ("order\t{go:GO} (Z there)", "is no role"),
        ("order\t{go:GO (G there)", "opens or closes nothing"),
        ("order\t{up:+}", "no verb before it"),
        ("order\t{go:GO} (G@3 there)", "no frame 3"),
        ("order\t{go:GO} *there", "inside one"),
    ],
)
def test_what_is_wrong_with_a_line_is_said_with_its_number(line: str, said: str) -> None:
    with pytest.raises(FileFormatError, match=said) as caught:
        list(read_text(f"# comment\n{line}\n", "mine.txt"))
    assert "line 2" in str(caught.value)


def test_all_sentences_that_the_tagger_learns_from_can_be_read() -> None:
    files = [file for file in SENTENCES.iterdir() if file.name.endswith(".txt")]
    assert sum(len(list(read_text(file.read_text(encoding="utf-8"), file.name))) for file in files) > 150
