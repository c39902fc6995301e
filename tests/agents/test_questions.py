"""Which questions of robots are open."""

from __future__ import annotations

import pytest

from parley.agents.questions import OpenQuestions, SeenIds, WrongAnswers
from parley.messages.chat import Aside, ChatFeedback, ChatInput


def ask(text: str, *targets: str) -> ChatFeedback:
    return ChatFeedback(message=text, targets=targets or ("A",), type="request", id=text)


def answer(questions: OpenQuestions, *targets: str, reply_to: str = "", kind: str = "response") -> None:
    questions.on_input(
        ChatInput.model_validate(
            {"message": "yes", "targets": targets or ("A",), "type": kind, "reply_to": reply_to}
        )
    )


def newest(questions: OpenQuestions, target: str = "A") -> str:
    found = questions.newest(target)
    return found.id if found else ""


@pytest.fixture
def questions() -> OpenQuestions:
    found = OpenQuestions()
    found.on_feedback(ask("one"))
    found.on_feedback(ask("two"))
    return found


def test_nobody_asked_anything() -> None:
    assert OpenQuestions().newest("A") is None


def test_an_answer_is_taken_for_the_newest_and_settles_it(questions: OpenQuestions) -> None:
    assert newest(questions) == "two"
    answer(questions)
    assert newest(questions) == "one"
    answer(questions)
    assert newest(questions) == ""


def test_answer_settles_the_question_it_names(questions: OpenQuestions) -> None:
    answer(questions, reply_to="one")
    assert newest(questions) == "two"
    answer(questions)
    assert newest(questions) == ""


def test_answer_to_a_question_nobody_asked_settles_nothing(questions: OpenQuestions) -> None:
    answer(questions, reply_to="three")
    assert newest(questions) == "two"


def test_order_settles_nothing(questions: OpenQuestions) -> None:
    answer(questions, kind="request")
    assert newest(questions) == "two"


@pytest.mark.parametrize("kind", ["info", "response", "error"])
def test_robot_withdraws_its_question_with_whatever_it_says(questions: OpenQuestions, kind: str) -> None:
    questions.on_feedback(
        ChatFeedback.model_validate({"message": "", "targets": ["A"], "type": kind, "closes": "two"})
    )
    assert newest(questions) == "one"


def test_robots_have_questions_of_their_own(questions: OpenQuestions) -> None:
    questions.on_feedback(ask("three", "B"))
    answer(questions, "B")
    assert (newest(questions), newest(questions, "B")) == ("two", "")


def test_robot_is_found_whatever_the_capitals(questions: OpenQuestions) -> None:
    assert newest(questions, "a") == "two"
    answer(questions, " a")
    assert newest(questions) == "one"


def test_what_robots_say_beside_questions_is_no_question() -> None:
    questions = OpenQuestions()
    questions.on_feedback(ChatFeedback(message="I am there.", targets=("A",)))
    assert questions.newest("A") is None


def test_answer_to_a_named_question_settles_it_whoever_it_was_sent_to(questions: OpenQuestions) -> None:
    questions.on_feedback(ask("three", "B"))
    answer(questions, "A", reply_to="three")
    assert (newest(questions), newest(questions, "B")) == ("two", "")


@pytest.mark.parametrize(
    ("message", "robots"),
    [
        ("Ada, take it", ["Ada"]),
        ("take it, ada!", ["Ada"]),
        ("it is beside Ada", ["Bob"]),
        ("Adam, take it", ["Bob"]),
        ("take it", ["Bob"]),
    ],
)
def test_robot_called_by_name_comes_before_the_one_it_was_sent_to(message: str, robots: list[str]) -> None:
    questions = OpenQuestions()
    questions.on_feedback(ask("one", "Ada"))
    questions.on_feedback(ask("two", "Bob"))
    said = ChatInput(message=message, targets=("Bob",), type="response")
    assert [robot for robot, _ in questions.answered(said)] == robots


def test_answer_for_nobody_is_only_clear_while_one_robot_waits() -> None:
    questions = OpenQuestions()
    questions.on_feedback(ask("one", "Ada"))
    said = ChatInput(message="yes", type="response")
    assert [robot for robot, _ in questions.answered(said)] == ["Ada"]
    questions.on_feedback(ask("two", "Bob"))
    assert questions.answered(said) == []
    assert questions.robots() == ["Ada", "Bob"]


def test_answer_is_late_once_its_question_is_settled_by_whatever_means(questions: OpenQuestions) -> None:
    questions.on_feedback(ChatFeedback(message="Which?", targets=("A",), type="request", id="q7"))
    answer = ChatInput(message="red", targets=("A",), type="response", reply_to="q7")
    assert not questions.is_late(answer)
    questions.on_input(answer)
    assert questions.is_late(answer)
    assert not questions.is_late(answer.model_copy(update={"reply_to": ""}))
    assert not questions.is_late(answer.model_copy(update={"reply_to": "nobody asked"}))
    assert not questions.is_late(answer.model_copy(update={"type": "request"}))


def test_only_so_many_ids_are_kept() -> None:
    seen = SeenIds(kept=2)
    assert [seen.is_new(name) for name in ("a", "b", "a", "c", "a", "", "")] == [
        True, True, False, True, True, True, True,
    ]  # fmt: skip


SAID = ChatInput(
    message="where is it?", targets=("A",), type="response", id="m1", reply_to="q1", author="Kim"
)
TOLD = Aside(actor="a", reply_to="q1", id="m1", message="where is it?")


def test_what_was_no_answer_becomes_a_message_in_the_words_of_who_said_it_once() -> None:
    wrong = WrongAnswers(lambda: 0.0)
    assert wrong.on_answer(SAID) == []
    made = wrong.on_aside(TOLD.model_copy(update={"message": "come here"}))
    assert made is not None
    assert (made.message, made.author, made.type, made.targets) == ("where is it?", "Kim", "request", ("a",))
    assert (made.id, made.reply_to) == (TOLD.request_id, "q1")
    assert wrong.on_aside(TOLD) is None


def test_a_robot_may_find_it_before_it_is_heard_here() -> None:
    wrong = WrongAnswers(lambda: 0.0)
    assert wrong.on_aside(TOLD) is None
    assert [made.message for made in wrong.on_answer(SAID)] == ["where is it?"]
    assert wrong.on_answer(SAID) == []


def test_what_a_robot_tells_of_long_before_it_is_said_waits_for_nobody() -> None:
    now = [0.0]
    wrong = WrongAnswers(lambda: now[0])
    wrong.on_aside(TOLD)
    now[0] = 61.0
    assert wrong.on_answer(SAID) == []


@pytest.mark.parametrize(
    ("aside", "after_s"),
    [
        (TOLD.model_copy(update={"actor": "B"}), 0.0),
        (TOLD.model_copy(update={"reply_to": "q2"}), 0.0),
        (TOLD.model_copy(update={"id": "m2"}), 0.0),
        (TOLD, 61.0),
    ],
    ids=["of another robot", "to another question", "of another message", "long ago"],
)
def test_nothing_becomes_of_what_nobody_answered_just_then(aside: Aside, after_s: float) -> None:
    now = [0.0]
    wrong = WrongAnswers(lambda: now[0])
    wrong.on_answer(SAID)
    now[0] = after_s
    assert wrong.on_aside(aside) is None
