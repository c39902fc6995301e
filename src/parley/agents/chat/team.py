"""What is said to several robots at once: understood once, split, and given to those who are done soonest."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations
from typing import Final

from parley.agents.chat.situations import Situations
from parley.agents.chat.texts import not_there
from parley.agents.planner.flow import pending_calls
from parley.agents.presence import Presence
from parley.gate.evidence import speaks_of_change
from parley.gate.orders import UNSURE_OF_ALL
from parley.gate.stop_words import calls_to_stop, opens_with_no
from parley.language.base import Language, Situation
from parley.language.dialogue.state import Asked, Order
from parley.latest import Latest
from parley.messages.chat import ActionCall, ChatAction, ChatInput, SystemCommand
from parley.messages.status import ActorStatus, PlanProposal
from parley.sentences import Sentence, listed, sentence, together
from parley.team.outlook import Outlook, Survey, Task
from parley.team.sharing import alike, in_turn, is_search, left_of, place_of, shared, tasks_of, why
from parley.team.wish import Part, TeamWish, is_in_turn, is_of_several
from parley.team.wishes import asked_by_name, gathered, is_unread, team_wish, turned_wish
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = ["Mission", "Share", "TeamTalk"]

TELL_EACH: Final = sentence("I cannot tell what of that can be done apart. Please tell each of us its part.")
WHO_DOES: Final = sentence("I cannot tell which of us is to do what. Please tell each of us its part.")
JUDGED: Final = sentence("We can wait until that is done, but not judge what is found. Shall we do it so?")
JUDGE_YOURSELF: Final = "We cannot judge that for each other. Say “{words}” once it is so."
WAITS: Final = "{robot} is waiting for somebody, so it gets no part."
TAKES_OVER: Final = "Let {other} take over from {robot}"
IN_FULL: Final = sentence("I do not know what you mean by that. Please say it in full.")
STOPPED: Final = sentence("you told me to stop")
LEFT_OUT: Final = "What {robots} had to do before is left out."
GIVES_UP: Final = "{robot} gives up what is left of its plan."
CHANGES: Final = "{robot} gets no part: it would change what it is at. Please tell it by itself."
CLEAR: Final = (SystemCommand(command="clear"),)
_EVERYBODY: Final = ("all", "each", "rest")
MOST_TASKS: Final = 40
"""More places than this are not shared in one order."""


@dataclass(frozen=True, slots=True)
class Share:
    """One robot's part."""

    robot: str
    calls: tuple[ActionCall, ...]
    why: Sentence | str = ""
    needs_yes: str = ""
    """What of the words was not understood."""
    after: tuple[str, ...] = ()
    """Robots whose parts of this mission have to be done before."""
    awaits: tuple[str, str] = ("", "")
    """A robot that has to be done with an order of its own before, and that order."""
    drops: tuple[SystemCommand, ...] = ()
    """What the robot gives up for it of what it is at."""


@dataclass(frozen=True, slots=True)
class Mission:
    """What comes of words to a team: parts, or something to say."""

    shares: tuple[Share, ...] = ()
    text: str = ""
    """What else is said: an answer, a question, who cannot do what."""
    choices: tuple[str, ...] = ()
    dropped: Mapping[str, str] = field(default_factory=dict)
    """By robot: its proposal in whose place this comes."""
    relieved: Mapping[str, str] = field(default_factory=dict)
    """Robots whose plans are given up, and who takes them over, if anybody does."""
    stands: tuple[str, ...] = ()
    """Robots that are at something and shall do nothing."""
    itself: tuple[str, str] | None = None
    """A robot, and words that only it can follow, as they change what it is at."""
    asked: tuple[str, Asked] | None = None
    """The one robot that would do it, and what it has to know first."""


@dataclass(frozen=True, slots=True)
class _Understood:
    """What one robot would do about the words of a part."""

    calls: tuple[ActionCall, ...]
    tasks: list[Task]
    needs_yes: str = ""
    drops: tuple[SystemCommand, ...] = ()
    """What it would give up for it."""


@dataclass(frozen=True, slots=True)
class _GivenOn:
    """What was said to a robot and is others' to do."""

    words: str
    takers: tuple[str, ...]
    behind: tuple[Order, ...]
    """What the robot itself had been told last then."""


class TeamTalk:
    """Understands what is said to several robots.

    Args:
        language: Understands the work itself.
        known: What was heard of each robot.
        presence: Who is there.
        survey: Says what each robot has before it; None: nobody can tell, so nothing is shared.
        offered: What of a robot waits for a yes.
    """

    def __init__(
        self,
        language: Language,
        known: Situations,
        presence: Presence,
        survey: Survey | None,
        offered: Callable[[str], PlanProposal | None],
    ) -> None:
        self._language, self._known, self._presence = language, known, presence
        self._survey, self._offered = survey, offered
        self._given_on: Latest[str, _GivenOn] = Latest()

    def turned(self, said: ChatInput) -> TeamWish | None:
        """What is said to be done behind words of stopping; None if whoever hears it reads that itself."""
        if self._survey is None:
            return None
        hearers = [name for target in said.targets if (name := self._presence.resolve(target))]
        return turned_wish(said.message, self._presence.ever(), hearers)

    def wish(self, message: str, hearer: str = "") -> TeamWish | None:
        """How words spread work over robots, or ask another one than `hearer`; None if they do not."""
        if self._survey is None:
            return None
        robots = self._presence.ever()
        wish = team_wish(message, robots, hearer)
        if wish is None and hearer and not calls_to_stop(message):
            return asked_by_name(message, robots, hearer)
        return wish

    async def unread(self, target: str, said: ChatInput) -> Mission | None:
        """A question back about words to a team of which a robot would make an order to itself."""
        read = is_unread(said.message, self._presence.names()) if self._survey is not None else None
        if read is None or (await self.understood(target, said.message, said))[0] is None:
            return None
        return Mission(text=WHO_DOES, choices=(read,) if read else ())

    async def mission(
        self, wish: TeamWish | None, target: str, said: ChatInput, team: Sequence[str]
    ) -> Mission | None:
        """What becomes of words to a team; None if they are to be understood by each robot for itself.

        Args:
            wish: How they spread work; None: the same was said to all of `team`.
            target: Whom it was said to.
            said: The message.
            team: Several robots that it was sent to; empty: all that are there are meant.
        """
        if self._survey is None:
            return None
        plain = wish is None
        wish = wish or TeamWish("parts", (Part("all", gathered(said.message)),))
        if wish.kind == "about":
            if (told := await self._asked(wish, said)) is not None:
                return told
            one = Part("named" if wish.robot else "each", wish.about, wish.robot)
            wish = TeamWish("parts", wish.parts or (one,))
        members = {
            name: status
            for name in team or self._presence.names()
            if (status := self._presence.get(name)) is not None and status.state != "stopped" and status.pose
        }
        if wish.kind == "swap":
            return self._swapped([part.robot for part in wish.parts], members)
        if wish.count and wish.count != len(team or self._presence.names()):
            return Mission(text=sentence("Which of us do you mean? Please call us by our names."))
        if (asked := self._asked_back(wish)) is not None:
            return asked
        work = _Work(self, said, members, plain=plain)
        if wish.kind == "nearest":
            return await work.nearest(wish.about)
        if wish.bare:
            return self._without_deed(wish)
        mission = await work.parts(wish, target)
        if mission is not None and wish.anew and not mission.relieved:
            mission = self._afresh(mission, target)
        if mission is not None and wish.turns:
            mission = self._turned(mission, wish)
        if mission is None or not mission.shares or all(part.who not in _EVERYBODY for part in wish.parts):
            return mission
        spared = {name for part in wish.parts for name in part.without}
        out = [name for name in team or self._presence.names() if name not in {*members, *spared}]
        return replace(mission, text=together(mission.text, *filter(None, map(self._why_out, out))))

    def _asked_back(self, wish: TeamWish) -> Mission | None:
        """A question back about words that say too little, or what we cannot do; None for other words."""
        if wish.kind == "help":
            return self.offered_instead(wish.parts[0].robot, wish.robot)
        if wish.kind == "stranger":
            nobody = sentence("No robot here is called “{words}”.", words=wish.about)
            return Mission(text=together(nobody, WHO_DOES))
        if wish.kind == "judged" and wish.bare:
            words = f"{wish.about[:1].upper()}{wish.about[1:]}"
            return Mission(text=sentence(JUDGE_YOURSELF, words=words), choices=(words,))
        if wish.kind == "judged":
            return Mission(text=JUDGED, choices=(wish.about,))
        return self._alone(wish.robot) if wish.kind == "alone" else None

    def _alone(self, robot: str) -> Mission:
        """A question what only one robot is to do: to go on, or what others are at."""
        others = [name for name in self._presence.names() if name != robot and self.is_busy(name)]
        goes_on = [sentence("Only {robot} goes on", robot=robot)] if others and self.is_busy(robot) else []
        over = [sentence(TAKES_OVER, other=robot, robot=name) for name in others if self.left(name)]
        choices = tuple(map(str, (*goes_on, *over)))
        return Mission(text=sentence("What shall only {robot} do?", robot=robot), choices=choices)

    def offered_instead(self, robot: str, of: str) -> Mission:
        """A question whether a robot shall do what another one is at."""
        if not self.left(of):
            return Mission(text=sentence("{robot} has nothing left to do.", robot=of))
        words = str(sentence(TAKES_OVER, other=robot, robot=of))
        text = sentence("Do you mean what {robot} is at? Then say “{words}”.", robot=of, words=words)
        return Mission(text=text, choices=(words,))

    def _without_deed(self, wish: TeamWish) -> Mission:
        """A question what is to be done, where only places are named."""
        if wish.kind == "parts":
            ways = (
                ", ".join(f"{part.robot} {verb} {part.order}" for part in wish.parts)
                for verb in ("checks", "goes to")
            )
            return Mission(text=sentence("What shall we do there?"), choices=tuple(ways))
        (part,) = wish.parts
        who = [name for name in self._presence.names() if name not in part.without]
        lead = f"{' and '.join(who)} " if part.without else ""
        among = "between them" if part.without else "split between you"
        ways = (f"{lead}{verb} {part.order}, {among}" for verb in ("check", "go to"))
        choices = tuple(f"{way[:1].upper()}{way[1:]}" for way in ways)
        return Mission(text=sentence("What shall we do about {what}?", what=part.order), choices=choices)

    def _afresh(self, mission: Mission, target: str) -> Mission:
        """The same in place of what was said last to a robot, and of what those who do it are at."""
        doers, given = {share.robot for share in mission.shares}, self._given_on.get(target)
        concerned = {target, *doers, *(given.takers if given is not None else ())}
        busy = sorted(name for name in concerned if self.is_busy(name))
        if not mission.shares or not busy:
            return mission
        text = sentence(LEFT_OUT, robots=listed(busy))
        shares = tuple(
            replace(one, drops=CLEAR if one.robot in busy else one.drops) for one in mission.shares
        )
        gone = {name: "" for name in busy if name not in doers}
        return replace(
            mission, shares=shares, text=together(text, mission.text), relieved={**mission.relieved, **gone}
        )

    def _turned(self, mission: Mission, wish: TeamWish) -> Mission:
        """The same in place of what those who do it are at; after a yes if somebody called to stop."""
        busy = sorted(share.robot for share in mission.shares if self.is_busy(share.robot))
        why = STOPPED if wish.turns == "asked" else ""
        shares = tuple(
            replace(one, drops=CLEAR if one.robot in busy else one.drops, needs_yes=one.needs_yes or why)
            for one in mission.shares
        )
        waiting = {one.robot: offer.id for one in shares if (offer := self._offered(one.robot)) is not None}
        text = together(sentence(LEFT_OUT, robots=listed(busy)) if busy and not why else "", mission.text)
        return replace(mission, shares=shares, text=text, dropped={**waiting, **mission.dropped})

    def _swapped(self, named: Sequence[str], members: Mapping[str, ActorStatus]) -> Mission | None:
        """Two robots do what is left of each other's plans; None: none of them have such."""
        left = {name: tasks for name in members if (tasks := self.left(name))}
        two = [name for name in named or left if name in left]
        if not left or (len(two) < 2 and not named):
            return None
        if len(two) < 2:
            idle = next((name for name in named if name not in left), "")
            return Mission(text=sentence("{robot} has nothing left to do.", robot=idle))
        if len(two) > 2:
            pairs = tuple(f"Swap {one} and {other}" for one, other in combinations(two, 2))
            return Mission(text=sentence("Which two of us do you mean?"), choices=pairs)
        shares = []
        for robot, other in (two, two[::-1]):
            if not can_do(members[robot], left[other]):
                return Mission(text=sentence("{robot} cannot do that.", robot=robot))
            shares.append(Share(robot, tuple(call for task in left[other] for call in task), drops=CLEAR))
        return Mission(tuple(shares), relieved=dict((two, two[::-1])))

    def _why_out(self, robot: str) -> Sentence | None:
        """Why a robot that is there takes no part in what everybody was told."""
        status = self._presence.get(robot)
        if status is None:
            return None
        if status.state == "stopped":
            return sentence("{robot} is stopped, so it takes no part.", robot=robot)
        return sentence("{robot} does not know where it is, so it takes no part.", robot=robot)

    async def _asked(self, wish: TeamWish, said: ChatInput) -> Mission | None:
        """A question about one robot or all, answered by whom it is about; None: that takes deeds."""
        asked_all = dict.fromkeys((wish.robot,) if wish.robot else self._presence.ever(), wish.about)
        words = {part.robot: part.order for part in wish.parts} or asked_all
        asked = [*words]
        names = [name for name in asked if self._presence.is_there(name)]
        situations = [await self._situation(robot, words[robot], said) for robot in names]
        answers = await asyncio.gather(*map(self._language.interpret, situations))
        if any(answer.queue for answer in answers):
            return None
        told = [
            sentence("{robot} says: “{answer}”", robot=robot, answer=answer.message_response)
            for robot, answer in zip(names, answers, strict=True)
        ]
        gone = [not_there(name) for name in asked if name not in names]
        return Mission(text=together(*told, *gone))

    async def _situation(self, robot: str, words: str, said: ChatInput) -> Situation:
        found = await self._known.of(robot, words, said, sees_pictures=False, proposal=self._offered(robot))
        return replace(found, robots=(robot,))

    async def understood(
        self, robot: str, words: str, said: ChatInput
    ) -> tuple[_Understood | None, ChatAction]:
        """What a robot would do about words, and all it has to say to them."""
        situation = await self._situation(robot, words, said)
        answer = await self._language.interpret(situation)
        calls = answer.queue or answer.offer
        drops = answer.system_cmd if speaks_of_change(said.message) else ()
        changes = bool(answer.system_cmd) and {c.command for c in drops} - {"clear", "pop"} != set()
        changes = changes or len(drops) < len(answer.system_cmd)
        if not calls or changes or answer.alarm or answer.targets not in ((), (robot,)):
            return None, answer
        doubt = answer.needs_yes or ("" if answer.queue else UNSURE_OF_ALL)
        return _Understood(calls, tasks_of(calls, situation.catalogue), doubt, drops), answer

    async def outlooks(
        self,
        members: Mapping[str, ActorStatus],
        tasks: Sequence[Task],
        booked: Mapping[str, Sequence[ActionCall]],
    ) -> dict[str, Outlook]:
        """What each robot has before it; `booked` is what it has just been given."""
        assert self._survey is not None
        found: dict[str, Outlook] = {}
        for name, status in members.items():
            assert status.pose is not None
            plan = self._known.plans.get(name)
            pending = [*(pending_calls(plan) if plan else ()), *booked.get(name, ())]
            pose = Pose2D(status.pose.x, status.pose.y, status.pose.yaw)
            outlook = await self._survey(name, status.catalogue, pose, pending, tasks)
            if outlook is not None:
                found[name] = outlook
        return found

    async def give_on(self, target: str, said: ChatInput, takers: Sequence[str]) -> None:
        """What was said to a robot becomes others' work: that is what "that" means to it from now on."""
        orders = (await self._situation(target, said.message, said)).dialogue.orders
        self._given_on[target] = _GivenOn(said.message, tuple(takers), orders[-1:])

    async def given_to(self, target: str, said: ChatInput) -> tuple[str, ...]:
        """Who got what was said to a robot last."""
        given = self._given((await self._situation(target, said.message, said)).dialogue.orders, target)
        return given.takers if given is not None else ()

    def _given(self, orders: Sequence[Order], target: str) -> _GivenOn | None:
        """What was said to a robot last, if that was others' to do."""
        given = self._given_on.get(target)
        own = given is None or target in given.takers or given.behind != (*orders[-1:],)
        return None if own else given

    async def said_last(self, target: str, said: ChatInput) -> tuple[str, str]:
        """The words that "that" means, and the proposal of it that waits; or why they cannot be given on."""
        situation = await self._situation(target, said.message, said)
        proposal, orders = self._offered(target), situation.dialogue.orders
        if proposal is not None and proposal.words:
            return proposal.words, proposal.id
        if (given := self._given(orders, target)) is not None:
            return ("" if any(map(self.left, given.takers)) else given.words), ""
        if orders and not situation.queue:
            return orders[-1].words, ""
        asked = situation.dialogue.asked
        return (asked.words if asked is not None and not situation.queue else ""), ""

    def left(self, robot: str) -> list[Task]:
        """What a robot still has to do, each task from its beginning."""
        plan = self._known.plans.get(robot)
        return left_of(plan.steps, self._known.catalogue(robot)) if plan is not None else []

    async def stand_in(self, robot: str, team: Sequence[str]) -> tuple[str, Sentence] | None:
        """Who of a team could best do what is left of a robot's plan, and why."""
        tasks = self.left(robot)
        members = {
            name: status
            for name in team
            if name != robot
            and (status := self._presence.get(name)) is not None
            and status.state != "stopped" and status.pose and not self.stands(name)
            and can_do(status, tasks)
        }  # fmt: skip
        if not tasks or not members:
            return None
        whole = tuple(call for task in tasks for call in task)
        outlooks = await self.outlooks(members, [whole], {})
        able = {name: [True] for name in outlooks}
        batteries = {name: members[name].battery for name in outlooks}
        found = shared([whole], outlooks, able, batteries) if outlooks else None
        if not found:
            return None
        name = next(iter(found))
        return name, why(name, whole, 0, outlooks, able, batteries)

    def order_of(self, robot: str) -> str:
        """The order that a robot does last of what it has to do; empty: it has nothing to do."""
        plan = self._known.plans.get(robot)
        orders = [step.order for step in plan.steps if step.order] if plan is not None else []
        return orders[-1] if orders and self.is_busy(robot) else ""

    def offers(self, robot: str) -> bool:
        """Whether steps of a robot wait for a yes."""
        return self._offered(robot) is not None

    def charging(self, robot: str) -> list[MapObject]:
        """Where robots charge, as a robot's map has it."""
        return [item for item in self._known.objects(robot) if item.charges]

    def is_busy(self, robot: str) -> bool:
        """Whether a robot has something left to do."""
        plan = self._known.plans.get(robot)
        return plan is not None and bool(pending_calls(plan))

    def stands(self, robot: str) -> bool:
        """Whether a robot waits for a person before it goes on with anything."""
        return self._known.state(robot) in ("held", "paused")


def can_do(status: ActorStatus, tasks: Sequence[Task]) -> bool:
    """Whether a robot has all the actions."""
    known = {info.name for info in status.catalogue}
    return all(call.name in known for task in tasks for call in task)


def _why_not(tasks: Sequence[Task], takers: Mapping[str, Outlook]) -> Sentence:
    """Why work is not given out: a place that nobody gets to is named."""
    for at, task in enumerate(tasks):
        if takers and place_of(task) and all(one.ways_m[at] == float("inf") for one in takers.values()):
            return sentence("None of us can get to “{place}”.", place=place_of(task))
    return sentence("We cannot do all of that.")


def _how_to_share(part: Part, words: str, robots: Sequence[str]) -> Mission:
    """Ask whether several things are to be shared, or done by everybody."""
    text = sentence("Shall we share that, or shall each of us do all of it?")
    but = f" but {' and '.join(part.without)}" if part.without else ""
    share = f"{' and '.join(robots)} {words}, between them" if but else f"{words}, split between you"
    return Mission(text=text, choices=(share, f"each of you{but}: {words}"))


class _Work:
    """One message to a team.

    Args:
        team: What it is understood with.
        said: The message.
        members: The robots that may take part.
        plain: Whether the words say nothing of a team, so that each may well understand them for itself.
    """

    def __init__(
        self, team: TeamTalk, said: ChatInput, members: Mapping[str, ActorStatus], *, plain: bool
    ) -> None:
        self._team, self._said, self._members, self._plain = team, said, members, plain
        self._batteries = {name: status.battery for name, status in members.items()}
        self._shares: list[Share] = []
        self._notes: list[str] = []
        self._stands: list[str] = []
        self._dropped: dict[str, str] = {}

    async def nearest(self, place: str) -> Mission:
        """Who is nearest to a place."""
        ways: dict[str, float] = {}
        for name, (found, answer) in (await self._read(f"go to {place}", self._members)).items():
            if found is None:
                return Mission(text=answer.message_response, choices=answer.choices)
            outlook = (await self._team.outlooks({name: self._members[name]}, found.tasks[:1], {})).get(name)
            if outlook is not None:
                ways[name] = outlook.ways_m[0]
                place = place_of(found.tasks[0]) or place
        reached = sorted((way, name) for name, way in ways.items() if way != float("inf"))
        if not reached:
            return Mission(text=sentence("None of us can get to “{place}”.", place=place))
        told = [sentence("{robot} {way} m", robot=name, way=f"{way:.1f}") for way, name in reached]
        first = sentence("{robot} is nearest to “{place}”.", robot=reached[0][1], place=place)
        return Mission(text=together(first, sentence("The ways are: {ways}.", ways=listed(told))))

    async def parts(self, wish: TeamWish, target: str) -> Mission | None:
        """Who does what of an order."""
        before: tuple[str, ...] = ()
        for part in self._but_one(wish.parts):
            if part.stays:
                self._stay(self._of(part, {share.robot for share in self._shares}))
                continue
            of = part.of or await self._whose(part, target)
            if (told := await self._as_before(part, of, wish)) is not None:
                return told
            if part.home:
                return self._where_to(part, alone=len(wish.parts) == 1)
            words, stops = await self._words(part, of or target)
            if stops is not None:
                return stops
            taken = {share.robot for share in self._shares}
            own = self._of(part, taken)
            if not own:
                return self._left_over(part, words)
            begun = len(self._shares)
            stops = await self._part(part, words, own, wish)
            if stops is not None:
                return stops if stops.text else None
            new = self._shares[begun:]
            if part.awaits:
                self._wait_for(part.awaits, begun)
            elif part.after:
                self._come_behind(begun, () if wish.kind == "share" else before)
            before = tuple(share.robot for share in new)
        if len({share.robot for share in self._shares}) < len(self._shares):
            return Mission(text=TELL_EACH)
        doubt = next((share.needs_yes for share in self._shares if share.needs_yes), "")
        shares = tuple(replace(share, needs_yes=doubt) for share in self._shares)  # all wait for one yes
        given_up = sorted(share.robot for share in shares if share.drops)
        if given_up:
            self._notes.append(sentence(LEFT_OUT, robots=listed(given_up)))
        text = together(*dict.fromkeys(self._notes))
        return Mission(shares, text, dropped=self._dropped, stands=tuple(self._stands))

    def _left_over(self, part: Part, words: str) -> Mission | None:
        """What is told of a part that nobody can do; None: each who heard the words may have an answer."""
        if self._plain:
            return None
        left = sentence("No robot is left for “{words}”, so nothing of that has begun.", words=words)
        gone = sentence("{robot} is not ready, so nothing of that has begun.", robot=part.robot)
        return Mission(text=gone if part.robot else left)

    def _but_one(self, parts: Sequence[Part]) -> list[Part]:
        """The parts, where some stay whoever they are: those are who is left by the others' part."""
        staying = [part for part in parts if part.stays and part.who in ("one", "some")]
        others = [part for part in parts if part.who in ("all", "rest") and not part.stays]
        if len(staying) != 1 or len(others) > 1:
            return [*parts]
        found = [part for part in parts if part is not staying[0]]
        named = {name for part in parts for name in (part.robot, *part.without) if name}
        go = len(self._members.keys() - named) - staying[0].count
        if others and go > 0:
            found[found.index(others[0])] = replace(others[0], who="some", count=go)
        return [*found, replace(staying[0], who="rest", without=(*named,))]

    def _stay(self, members: Mapping[str, ActorStatus]) -> None:
        """These do nothing."""
        for name in members:
            stands = not self._team.is_busy(name) or self._team.stands(name)
            self._stands += [] if stands else [name]
            self._notes.append(sentence("{robot} stays where it is.", robot=name))

    def _wait_for(self, robot: str, begun: int) -> None:
        """What was given out from `begun` on comes after what a robot is at."""
        order = self._team.order_of(robot)
        if not order:
            self._notes.append(sentence("{robot} has nothing left to do.", robot=robot))
        else:
            self._shares[begun:] = [replace(share, awaits=(robot, order)) for share in self._shares[begun:]]

    async def _as_before(self, part: Part, of: str, wish: TeamWish) -> Mission | None:
        """A part that is at work already, or waits: somebody else does the rest. None: it is no such part."""
        if part.robot and part.of_before and not wish.turns and self._team.stands(part.robot):
            return Mission(text=sentence(WAITS, robot=part.robot))
        if of and not (part.instead and (self._team.offers(of) or not self._team.left(of))):
            return await self._taken_over(part, of)
        return None

    async def _whose(self, part: Part, target: str) -> str:
        """Who has now what a part is to do instead; empty: nobody, or it is no such part.

        "Let Kim do that" said to one that is at something means that, and after a no what it gave to another.
        """
        named = part.of_before and part.robot != ""
        other = named and part.robot != target
        if part.instead or (other and self._team.left(target) and not self._team.offers(target)):
            return target
        if not named or not opens_with_no(self._said.message):
            return ""
        given = await self._team.given_to(target, self._said)
        takers = [name for name in given if name != part.robot and self._team.left(name)]
        return takers[0] if len(takers) == 1 else ""

    def _come_behind(self, begun: int, before: tuple[str, ...]) -> None:
        """What was given out from `begun` on waits for the parts of others; one's own is done just before."""
        earlier, later = self._shares[:begun], self._shares[begun:]
        for share in later:
            own = next((at for at, one in enumerate(earlier) if one.robot == share.robot), None)
            if own is None or {*before} - {share.robot}:
                earlier.append(replace(share, after=before))
            else:
                doubt, drops = earlier[own].needs_yes or share.needs_yes, earlier[own].drops or share.drops
                calls = (*earlier[own].calls, *share.calls)
                earlier[own] = replace(earlier[own], calls=calls, needs_yes=doubt, drops=drops)
        self._shares = earlier

    async def _taken_over(self, part: Part, of: str) -> Mission:
        """One robot does what is left of another one's plan: the one that is named, or whom it suits best."""
        found = None if part.robot else await self._team.stand_in(of, [*self._members])
        robot, reason = found or (part.robot, "")
        status = self._members.get(robot)
        tasks = self._team.left(of)
        if not tasks:
            text = sentence("{robot} has nothing left to do.", robot=of)
        elif not robot:
            text = sentence("We cannot do all of that.")
        elif status is None:
            text = sentence("{robot} is not ready, so nothing of that has begun.", robot=robot)
        elif not can_do(status, tasks):
            text = sentence("{robot} cannot do that.", robot=robot)
        else:
            calls = tuple(call for task in tasks for call in task)
            text = sentence(GIVES_UP, robot=of)
            return Mission((Share(robot, calls, reason),), text, relieved={of: robot})
        return Mission(text=text)

    def _where_to(self, part: Part, *, alone: bool) -> Mission:
        """It is to go back, and nobody said where to: mostly that is where robots charge."""
        known = {item.description for name in self._members for item in self._team.charging(name)}
        who = part.robot or "Everybody"
        but = f" but {' and '.join(part.without)}" if part.without else ""
        choices = tuple(f"{who}{but} back to the {name}" for name in sorted(known)) if alone else ()
        return Mission(text=sentence("Where to? Please say it with the place."), choices=choices)

    async def _words(self, part: Part, target: str) -> tuple[str, Mission | None]:
        """The words of a part, with what "that" means."""
        if part.order or part.alike:
            return part.order or part.alike, None
        words, proposal = await self._team.said_last(target, self._said)
        if not words:
            others = [name for name in self._members if name != part.robot and self._team.left(name)]
            if part.robot and len(others) == 1 and not self._team.left(part.robot):
                return "", self._team.offered_instead(part.robot, others[0])
            busy = self._team.is_busy(target)
            text = sentence("I am at something already. Say “cancel everything” first, then say it in full.")
            return "", Mission(text=text if busy else IN_FULL)
        if proposal:
            self._dropped[target] = proposal
        if (before := self._team.wish(words)) is not None:  # it was for a team itself: only the work is meant
            works = {one.order for one in before.parts}
            words = works.pop() if len(works) == 1 else ""
        return (words, None) if words else ("", Mission(text=IN_FULL))

    def _of(self, part: Part, taken: set[str]) -> dict[str, ActorStatus]:
        """The robots a part may fall to."""
        if part.who == "named":
            return {name: status for name, status in self._members.items() if name == part.robot}
        gone = {*part.without, *(taken if part.who in ("rest", "one", "some") else ())}
        return {name: status for name, status in self._members.items() if name not in gone}

    async def _read(
        self, words: str, members: Mapping[str, ActorStatus]
    ) -> dict[str, tuple[_Understood | None, ChatAction]]:
        found = await asyncio.gather(*(self._team.understood(name, words, self._said) for name in members))
        return dict(zip(members, found, strict=True))

    async def _part(
        self, part: Part, words: str, own: Mapping[str, ActorStatus], wish: TeamWish
    ) -> Mission | None:
        """Take up a part. A mission with a text stops all of it, an empty one leaves it to each robot."""
        read = await self._read(words, own)
        able = {name: found for name, (found, _) in read.items() if found is not None}
        if not able and part.alike and part.alike != words:
            return await self._part(part, part.alike, own, wish)
        if not able:
            answer = next(iter(read.values()))[1]
            if self._plain or answer.alarm:
                return Mission()
            if answer.system_cmd:  # what it says it would do is not done here
                alone = len(own) == len(wish.parts) == 1
                return Mission(text=TELL_EACH, itself=(next(iter(own)), words) if alone else None)
            left = Asked(answer.left_open.about or words, answer.choices, answer.left_open.where)
            asked = (next(iter(own)), left) if len(own) == 1 and (left.where or left.choices) else None
            return Mission(text=answer.message_response, choices=answer.choices, asked=asked)
        first = next(iter(able.values()))
        splits = alike(first.tasks) and not is_in_turn(words)
        shares = wish.kind == "share" and not part.after
        if shares and not splits and len(first.tasks) > 1:
            return Mission(text=TELL_EACH)
        together = part.who in ("all", "rest") and wish.kind == "parts" and len(own) > 1 < len(first.tasks)
        fits = len(first.tasks) == len(own) == (part.count if part.who == "all" else len(own))
        if together and not (splits and (fits or is_of_several(words) or " and " not in words)):
            return _how_to_share(part, words, [*own])
        if part.who in ("one", "some"):
            if (
                part.count > 1 and splits and len(first.tasks) > 1
            ):  # "two of you check the areas" is not that both check all
                return await self._allot([*first.tasks], first, able, part, one_each=False)
            return await self._allot([first.calls] * part.count, first, able, part, one_each=True)
        if shares or together:
            tasks = list(first.tasks) if splits else [first.calls]
            return await self._allot(tasks, first, able, part, one_each=wish.one_each)
        self._each(part, own, able, read)
        return None

    def _each(
        self,
        part: Part,
        own: Mapping[str, ActorStatus],
        able: Mapping[str, _Understood],
        read: Mapping[str, tuple[_Understood | None, ChatAction]],
    ) -> None:
        """Everybody does all of a part."""
        for name in own:
            if part.who == "rest" and self._team.stands(name):
                self._notes.append(sentence(WAITS, robot=name))
            elif name in able:
                one = able[name]
                self._shares.append(Share(name, one.calls, needs_yes=one.needs_yes, drops=one.drops))
            else:
                said = read[name][1]
                note = sentence(
                    "{robot} gets no part. It says: “{answer}”", robot=name, answer=said.message_response
                )
                if said.system_cmd:
                    note = sentence(CHANGES, robot=name)
                self._notes.append(note)

    async def _allot(
        self,
        tasks: list[Task],
        first: _Understood,
        read: Mapping[str, _Understood],
        part: Part,
        *,
        one_each: bool,
    ) -> Mission | None:
        """Give tasks to those who are done soonest, or one to the nearest."""
        if len(tasks) > MOST_TASKS:
            return Mission(
                text=sentence("That is too much to share in one order. Please say it in shorter pieces.")
            )
        booked = {share.robot: share.calls for share in self._shares}
        free = [name for name in read if not self._team.stands(name)] or [*read]
        for name in read.keys() - {*free}:
            self._notes.append(sentence(WAITS, robot=name))
        outlooks = await self._team.outlooks({name: self._members[name] for name in free}, tasks, booked)
        able = {
            name: [task in read[name].tasks or task == read[name].calls for task in tasks]
            for name in outlooks
        }
        takers = self._takers(part, outlooks)
        most = part.count if part.who == "some" else len(takers)
        routes = (
            shared(tasks, takers, able, self._batteries, one_each=one_each, most=most) if takers else None
        )
        if routes is None:
            return Mission(text=_why_not(tasks, takers))
        for name, route in routes.items():
            reason = why(name, route[0], tasks.index(route[0]), outlooks, able, self._batteries)
            if part.fullest and len(takers) < len(outlooks):
                reason = sentence("{robot} has the fullest battery", robot=name)
            calls = in_turn(route, search=len(route) > 1 and is_search(first.calls))
            self._shares.append(Share(name, calls, reason, first.needs_yes, drops=read[name].drops))
        return None

    def _takers(self, part: Part, outlooks: Mapping[str, Outlook]) -> dict[str, Outlook]:
        """Those to whom a part may fall, of all that could do it."""
        names = [*outlooks]
        if part.idle:
            names = [name for name in names if not self._team.is_busy(name)] or names
        if part.nearest and names:
            names = [min(names, key=lambda name: outlooks[name].ways_m[0])]
        if part.fullest:
            most = max((self._batteries.get(name) or 0.0 for name in names), default=0.0)
            names = [name for name in names if (self._batteries.get(name) or 0.0) >= most]
        return {name: outlooks[name] for name in names}
