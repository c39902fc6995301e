"""A message that a program repeats by itself, and one that a person says twice."""

from __future__ import annotations

from parley.messages.chat import ChatInput
from parley.messages.repeats import Repeats

ORDER = ChatInput(message="go to the door", targets=("Kim",))


def counts(*heard: tuple[float, ChatInput]) -> list[int]:
    repeats = Repeats()
    return [repeats.count(said, now_s) for now_s, said in heard]


def test_what_comes_once_a_second_is_one_message_however_long_it_goes_on() -> None:
    assert counts(*((float(second), ORDER) for second in range(5))) == [0, 1, 2, 3, 4]


def test_what_is_said_anew_after_a_while_is_a_new_message() -> None:
    assert counts((0, ORDER), (1, ORDER), (4, ORDER), (5, ORDER)) == [0, 1, 0, 1]


def test_another_message_robot_or_person_is_no_repetition() -> None:
    others = ({"message": "go to the box"}, {"targets": ("Ada",)}, {"author": "Lee"})
    assert counts((0, ORDER), *((1, ORDER.model_copy(update=one)) for one in others)) == [0, 0, 0, 0]


def test_a_message_with_an_id_is_recognised_by_that_alone() -> None:
    said = ORDER.model_copy(update={"id": "a"})
    assert counts((0, said), (1, said)) == [0, 0]
