"""What is done at once, what waits for a yes, and what is refused."""

from __future__ import annotations

import pytest

from parley.gate.ruling import Policy, rule
from parley.messages.chat import ActionCall, CommandName, SystemCommand
from parley.messages.principal import Principal, person

KIM, ENGINE = person("Kim"), Principal(kind="engine", name="model")
RULE = Principal(kind="rule", name="Kim")
GO = (ActionCall(name="Go"),)


def commands(*names: CommandName) -> tuple[SystemCommand, ...]:
    return tuple(SystemCommand(command=name) for name in names)


@pytest.mark.parametrize(
    ("policy", "risky", "begins"),
    [
        ("run_at_once", True, "now"),
        ("ask_when_risky", False, "now"),
        ("ask_when_risky", True, "ask"),
        ("ask_first", False, "ask"),
    ],
)
def test_an_engines_steps_begin_as_the_policy_says(policy: Policy, risky: bool, begins: str) -> None:
    assert rule(ENGINE, policy, GO, (), risky=risky).begins == begins
    assert rule(KIM, policy, GO, (), risky=risky).begins == "now"


def test_an_engine_never_lets_a_robot_go_on_and_always_may_hold_it() -> None:
    found = rule(ENGINE, "run_at_once", (), commands("start", "stop"))
    assert (found.do, found.refused) == (commands("stop"), commands("start"))


def test_what_a_person_holds_an_engine_changes_only_after_a_yes() -> None:
    held = rule(ENGINE, "run_at_once", GO, commands("clear"), held_by=KIM)
    assert (held.do, held.ask, held.begins) == ((), commands("clear"), "ask")
    for command in commands("clear", "skip", "pop"):
        assert rule(ENGINE, "run_at_once", (), (command,), held_by=KIM).ask == (command,)
        assert rule(ENGINE, "run_at_once", (), (command,), held_by=KIM, harmless=[command]).do == (command,)
    free = rule(ENGINE, "run_at_once", GO, commands("clear"))
    assert (free.do, free.begins) == (commands("clear"), "now")


def test_what_is_asked_about_is_not_done_in_part_before_the_answer() -> None:
    drop, skip = commands("pop", "skip")
    both = rule(ENGINE, "run_at_once", (), (drop, skip), held_by=KIM, harmless=[drop])
    assert (both.do, both.ask) == ((), (drop, skip))


def test_a_rule_lets_go_on_what_it_held_itself_and_nothing_else() -> None:
    assert rule(RULE, "run_at_once", (), commands("start"), held_by=RULE).do == commands("start")
    assert rule(RULE, "run_at_once", (), commands("start"), held_by=KIM).do == ()
    assert rule(RULE, "run_at_once", (), commands("start")).do == ()


def test_one_question_is_asked_about_all_of_an_order() -> None:
    found = rule(ENGINE, "ask_first", GO, commands("pop"))
    assert (found.do, found.ask, found.begins) == ((), commands("pop"), "ask")


def test_a_program_that_nobody_vouches_for_always_asks() -> None:
    assert rule(None, "run_at_once", GO, ()).begins == "ask"
