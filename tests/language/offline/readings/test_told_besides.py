"""What is told beside an order is kept, whichever reading of the message is taken."""

from __future__ import annotations

from parley.language.offline.readings.told_besides import with_what_is_told
from parley.language.offline.sentences.units import Unit
from parley.language.offline.words.text import tokens
from parley.messages.chat import ActionCall, ChatAction, SystemCommand

PLAN = ChatAction(message_response="I will go to the barn.", queue=(ActionCall(name="go"),))
PARTS = (
    Unit("told", 0, 6, tokens("the ladder is in the loft"), names=(tokens("loft"),)),
    Unit("order", 7, 11, tokens("go to the barn"), names=(tokens("barn"),)),
)


def keeping(data: str, name: str = "ladder_location") -> ChatAction:
    kept = SystemCommand(command="add_memory", arguments={"name": name, "type": "text", "data": data})
    said = f"I will remember that {data[0].lower()}{data[1:]}. I did not understand the rest."
    return ChatAction(message_response=said, system_cmd=(kept,))


def test_where_something_is_told_to_be_is_kept_with_the_plan_of_another_reading() -> None:
    first = keeping("The ladder is in the loft")
    found = with_what_is_told(PLAN, first, PARTS)
    assert (found.queue, found.system_cmd) == (PLAN.queue, first.system_cmd)
    assert found.message_response == "I will remember that the ladder is in the loft. I will go to the barn."


def test_nothing_else_comes_along() -> None:
    # A place that only the order names, a fact about no place, and a reading that keeps facts of its own.
    assert with_what_is_told(PLAN, keeping("The ladder is in the barn"), PARTS) is PLAN
    assert with_what_is_told(PLAN, keeping("The ladder is old, see the loft", "ladder"), PARTS) is PLAN
    knowing = PLAN.model_copy(update={"system_cmd": (SystemCommand(command="clear"),)})
    assert with_what_is_told(knowing, keeping("The ladder is in the loft"), PARTS) is knowing


def test_without_a_plan_nothing_is_added() -> None:
    idle = ChatAction(message_response="What should I do?")
    assert with_what_is_told(idle, keeping("The ladder is in the loft"), PARTS) is idle
