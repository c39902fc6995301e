"""The markup of annotated sentences, and whether what lies there can be read."""

from __future__ import annotations

import hashlib
import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from importlib import resources
from pathlib import Path

import pytest
import yaml

from parley.errors import FileFormatError
from parley_train.data import data_hash, held_back, written
from parley_train.markup import read_line, read_text

EVALUATION = sorted((Path(__file__).parents[3] / "eval").glob("*.yaml"))
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def test_a_sentence_is_read_with_its_frames_roles_and_owners() -> None:
    read = read_line(
        "told\t(T *Kim) {is:BELOC} (L at the *gate) , <order> {pick:TAKE} (T the red *crate on the ramp) "
        "{up:+} and {don't drop:!PUT} (T it) (L@2 in the *yard)"
    )
    take = read.triggers[1]
    assert [(trigger.frame, trigger.mode) for trigger in read.triggers] == [
        ("BELOC", "plain"), ("TAKE", "plain"), ("PUT", "negated"),
    ]  # fmt: skip
    assert [read.words[number] for number in take.particles] == ["up"]
    assert [(span.role, read.words[span.head], span.owner) for span in read.roles] == [
        ("T", "Kim", 0), ("L", "gate", 0), ("T", "crate", 1), ("T", "it", 2), ("L", "yard", 1),
    ]  # fmt: skip
    assert (read.acts[0], read.acts[-1]) == ("told", "order")


def test_a_move_stands_in_place_of_its_act_and_a_sign_says_how_a_deed_is_meant() -> None:
    read = read_line("yes\tyes , <order> before you {leave:>GO} {ring:<DO} and {use:^DO} (T the *lift)")
    assert (read.acts[0], read.moves[0], read.acts[-1], read.moves[-1]) == ("answer", "yes", "order", "none")
    assert [trigger.mode for trigger in read.triggers] == ["later", "earlier", "allowed"]


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


def test_no_writer_is_learnt_from_and_measured_on_and_no_sentence_of_the_evaluation_is_either() -> None:
    learnt, held = ({as_words(" ".join(one.words)) for one in part} for part in (written(), held_back()))
    assert len(learnt) > 5500 and len(held) > 550
    longer = {text for text in learnt & held if len(text.split()) > 3}
    assert len(longer) < 5, longer
    asked = {as_words(text) for file in EVALUATION for text in strings(yaml.load(file.read_bytes(), LOADER))}
    assert not {text for text in learnt | held if len(text.split()) > 2} & asked


def strings(value: object) -> Iterator[str]:
    """All texts in what was read from a file."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        yield from strings(list(value.values()))
    elif isinstance(value, list):
        for part in value:
            yield from strings(part)


def as_words(text: str) -> str:
    """In small letters, without marks."""
    return " ".join(re.findall(r"[a-z0-9]+", text.lower().replace("'", "")))


def test_weights_and_data_belong_together() -> None:
    folder = resources.files("parley.language.builtin") / "weights"
    card = json.loads((folder / "card.json").read_text(encoding="utf-8"))
    weights = hashlib.sha256((folder / "tagger.onnx").read_bytes()).hexdigest()
    assert (card["data_sha256"], card["weights_sha256"]) == (data_hash(), weights), "run make train"


@pytest.mark.parametrize(
    ("text", "said"),
    [("order\t{go:GO} (G to the *box)\n", "1 sentences, 1 frames"), ("order\t{go:FLY}\n", "line 1")],
)
def test_a_file_is_checked_from_the_command_line(tmp_path: Path, text: str, said: str) -> None:
    file = tmp_path / "mine.txt"
    file.write_text(text, encoding="utf-8")
    done = checked(str(file))
    assert said in done.stdout + done.stderr and done.returncode == ("line" in said)
    assert "usage" in checked().stderr


def checked(*arguments: str) -> subprocess.CompletedProcess[str]:
    where = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-m", "parley_train.markup", *arguments]
    return subprocess.run(command, capture_output=True, text=True, env=where, check=False)
