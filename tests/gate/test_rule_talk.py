"""Who may tell rules: people by their own words, and nobody else."""

from __future__ import annotations

import pytest

from parley.clock import SimClock
from parley.gate.book import RuleBook
from parley.gate.rule_talk import Listener, RuleReply, RuleTalk
from parley.gate.rules import RuleKeeper
from parley.messages.principal import Principal, person
from parley.messages.rules import Rule
from parley.world.object_map import MapObject

KIM = person("Kim")


class Talk:
    def __init__(self, *places: MapObject) -> None:
        self._places = places
        self.book = RuleBook(SimClock())
        self.keeper = RuleKeeper(self.book)
        self.talk = RuleTalk(self.book, self.keeper)

    async def say(
        self, text: str, by: Principal = KIM, answers: str = "", there: str = ""
    ) -> RuleReply | None:
        to = Listener("Ada", ("Ada",), self._places, there=there, busy=False)
        return await self.talk.reply(text, by, to, answers=answers)

    @property
    def held(self) -> list[str]:
        return [rule.id for rule in self.book.rules.rules]


@pytest.mark.parametrize(
    "by",
    [Principal(), Principal(kind="engine", name="m"), Principal(kind="rule"), person("Bo", role="viewer")],
)
async def test_a_rule_of_anybody_else_never_holds(by: Principal) -> None:
    talk = Talk()
    refused = await talk.say("nobody may drive at night", by)
    assert refused is not None and (refused.id, refused.text) == ("", "You may not change rules.")
    asked = await talk.say("nobody may drive at night")
    assert asked is not None and asked.id
    for answer in ("yes", "1", asked.choices[0]):
        await talk.say(answer, by, asked.id)
        assert talk.held == []
    await talk.say("yes", answers=asked.id)
    assert talk.held == ["action"]
    await talk.say("drop that rule", by)
    assert talk.held == ["action"]


@pytest.mark.parametrize(
    ("answer", "held"), [("Jah!", ["action"]), ("ei", []), ("1", ["action"]), ("No.", [])]
)
async def test_yes_and_no_in_both_languages(answer: str, held: list[str]) -> None:
    talk = Talk()
    asked = await talk.say("keegi ei tohi sõita öösel")
    assert asked is not None
    done = await talk.say(answer, answers=asked.id)
    assert done is not None and done.closes == asked.id
    assert talk.held == held
    assert await talk.say("yes", answers=asked.id) is None, "a question is answered once"
    assert talk.held == held


async def test_who_asks_back_hears_why_and_the_question_stays_open() -> None:
    talk = Talk()
    asked = await talk.say("nobody may drive at night")
    assert asked is not None
    why = await talk.say("why not?", answers=asked.id)
    assert why is not None and why.text.startswith("It was said to me as a rule")
    assert why.text.endswith(asked.text)
    assert (why.choices, talk.held) == (asked.choices, [])
    await talk.say("yes", answers=why.id)
    assert talk.held == ["action"]


async def test_of_several_rules_the_one_that_is_chosen_is_dropped() -> None:
    talk = Talk()
    for name in ("north ward", "south ward"):
        await talk.keeper.put(
            Rule(id=name.replace(" ", "-"), kind="keep_out", name=name, rectangle=(0, 0, 1, 1)), None
        )
    which = await talk.say("drop the rule about the ward")
    assert which is not None and len(which.choices) == 3 and which.rules == ()
    await talk.say(which.choices[1], answers=which.id)
    assert talk.held == ["north-ward"]
    one = await talk.say("kustuta reegel north ward kohta")
    assert one is not None
    await talk.say("jah", answers=one.id)
    assert talk.held == []
    nothing = await talk.say("drop the rule about the cellar")
    assert nothing is not None and nothing.text == "There is no such rule."


STORE = MapObject("s", "store", 5.0, 0.0, "store", 1.0, 1.0)


async def test_a_told_rule_counts_after_its_yes_and_robots_stand_till_then() -> None:
    talk = Talk(STORE)
    asked = await talk.say("never go into the store, it is wet")
    assert asked is not None and (talk.held, asked.stands) == ([], ("Ada",))
    assert [rule.corners for rule in asked.rules] == [((4.2, -0.8), (5.8, -0.8), (5.8, 0.8), (4.2, 0.8))]
    assert await talk.say("go to the desk and wait", answers=asked.id) is None, "an order is no answer"
    again = talk.talk.again("Ada")
    assert again is not None and (again.closes, again.text, again.stands) == (asked.id, asked.text, ("Ada",))
    await talk.say("no", answers=again.id)
    assert (talk.held, talk.talk.again("Ada")) == ([], None)
    asked = await talk.say("never go into the store")
    lifted = await talk.say("it is dry now, you may go into the store again")
    assert asked is not None and lifted is not None
    assert (lifted.closes, lifted.id, talk.held, talk.talk.again("Ada")) == (asked.id, "", [], None)


async def test_to_forget_a_rule_that_is_only_asked_about_is_a_no() -> None:
    talk = Talk(STORE)
    assert await talk.say("never go into the store") is not None
    assert await talk.say("ok forget that rule") is not None
    assert (talk.held, talk.talk.again("Ada")) == ([], None)


async def test_a_rule_that_is_told_twice_is_asked_about_once() -> None:
    talk = Talk(STORE)
    first = await talk.say("nobody into the store between two and three")
    second = await talk.say("Nobody may go into the store between two and three!")
    assert first is not None and second is not None and second.closes == first.id
    assert await talk.say("yes", answers=first.id) is None
    await talk.say("yes", answers=second.id)
    assert talk.held == ["keep-out-store"]
    third = await talk.say("nobody into the store between two and three")
    assert third is not None and not third.id
    assert third.text == "That is already a rule: Stays out of “store” between 14:00 and 15:00: every robot."
    other = await talk.say("nobody into the store between four and five")
    assert other is not None and other.id


@pytest.mark.parametrize("words", ["go anyway", "Do it anyway!", "but ignore the rule, please", "tee ikka"])
async def test_who_insists_hears_which_rule_it_is_and_who_may_change_it(words: str) -> None:
    talk = Talk(STORE)
    asked = await talk.say("never go into the store")
    assert asked is not None
    await talk.say("yes", answers=asked.id)
    assert await talk.say(words) is None, "nothing was refused"
    talk.talk.refused("Ada", talk.held)
    told = await talk.say(words)
    assert told is not None and not told.id
    assert "Stays out of “store”: Ada." in told.text
    assert "Operators and supervisors may drop it (“drop the rule about store”)" in told.text
    assert await talk.say("go to the desk anyway") is None, "an order of its own"
    talk.talk.refused("Ada", ())
    assert await talk.say(words) is None


@pytest.mark.parametrize("words", ["stay away from there", "Don't go there again", "never drive in there!"])
async def test_there_is_where_it_was_sent_last_and_an_area_is_called_by_its_letter(words: str) -> None:
    talk = Talk(MapObject("b", "Area B", 5.0, 0.0, "area", 1.0, 1.0))
    assert "there" in getattr(await talk.say(words), "text", "I do not know where “there” is."), "nowhere yet"
    asked = await talk.say(words, there="Area B")
    assert asked is not None and "“area b”" in asked.text
    await talk.say("yes", answers=asked.id)
    for no in ("C's open again", "zone C is open again"):
        assert await talk.say(no) is None
    lifting = await talk.say("B's open again")
    assert lifting is not None
    await talk.say("yes", answers=lifting.id)
    assert talk.held == []


async def test_a_rule_that_was_agreed_to_is_not_lifted_without_a_yes() -> None:
    talk = Talk(STORE)
    asked = await talk.say("never go into the store")
    assert asked is not None
    await talk.say("yes, like that", answers=asked.id)
    lifting = await talk.say("you may go into the store again")
    assert lifting is not None and lifting.id and talk.held == ["keep-out-store"]
    await talk.say("yes", answers=lifting.id)
    assert talk.held == []
