"""Every word the terminal itself says to an operator, in English and Estonian.

What robots say comes over the conversation and is shown as it is. No words of robotics in here.
"""

from __future__ import annotations

import os
from collections.abc import Mapping

__all__ = ["LANGUAGES", "Texts", "choose_language"]

_ENGLISH = {
    "system": "Parley",
    "you": "You",
    "welcome": "You are talking to Parley. /help shows the commands, Ctrl-D leaves.",
    "understands": "What understands you: {name}.",
    "try": "For example:",
    "goodbye": "Goodbye.",
    "joined": "{robot} is here.",
    "left": "{robot} has left.",
    "lost": "No contact with {robot}.",
    "found": "{robot} is in contact again.",
    "no_robot": "No robot has answered yet, so nobody was told.",
    "selected": "You are now talking to {robot}.",
    "unknown_robot": "There is no robot called {name}. Here now: {robots}.",
    "plan_of": "{robot}'s plan:",
    "no_plan": "{robot} has nothing to do.",
    "proposal_of": "{robot} would do this:",
    "yes_or_no": "Answer yes or no.",
    "asks_first": "{robot} will ask before it begins a new plan.",
    "runs_at_once": "{robot} will begin new plans at once.",
    "approve_usage": "/approve on: be asked before a plan begins; /approve off: plans begin at once.",
    "stop_sent": 'Emergency stop for {robot}. To let it move again: /reset, then "carry on".',
    "stop_sent_all": 'Emergency stop for all robots. To let them move again: /reset all, then "carry on".',
    "stop_received": '{robot} is stopping. To let it move again: /reset, then "carry on".',
    "stop_at_rest": "{robot} stands still.",
    "stop_moving": "{robot} does not stand yet.",
    "stop_silent": "{robot} does not answer. Look whether it stands.",
    "stop_reset": '{robot} may move again. Write "carry on" to go on.',
    "interrupt_hint": "Press Ctrl-C again to leave.",
    "refused_latched": "{robot} was stopped by the emergency stop. Write /reset first.",
    "refused_message": "That could not be read, and nothing was changed: {problem}",
    "refused": "{robot} could not accept that, and nothing was changed.",
    "memory_empty": "Nothing is remembered yet.",
    "memory_title": "Remembered:",
    "memory_picture": "a picture: {info}",
    "memory_unavailable": "The memory does not answer at the moment.",
    "unknown_command": "There is no command {command}. /help shows what there is.",
    "did_you_mean": "There is no command {command}. Did you mean {suggestion}?",
    "sources": "remembered: {names}",
    "more_steps": "and {count} more",
    "state_idle": "ready",
    "state_running": "working",
    "state_paused": "paused",
    "state_held": "waiting for you",
    "state_awaiting_approval": "waiting for your yes",
    "state_question": "waiting for your answer",
    "state_stopped": "stopped, /reset lets it move again",
    "state_lost": "no contact",
    "step_queued": "to do",
    "step_running": "now",
    "step_finished": "done",
    "step_failed": "did not work",
    "step_stopped": "stopped",
    "step_skipped": "left out",
    "step_paused": "paused",
    "step_waiting": "waiting for you",
    "yes_words": "yes y ok okay sure agreed",
    "no_words": "no n nope",
    "help_intro": "Write what you want in your own words. Numbers answer questions with numbered choices.",
    "help_help": "show this",
    "help_plan": "show the plan",
    "help_approve": "on: be asked before a plan begins; off: plans begin at once",
    "help_stop": "emergency stop; all: of every robot",
    "help_reset": "let it move again after an emergency stop",
    "help_robots": "who is here",
    "help_robot": "talk to another robot",
    "help_memory": "show what is remembered",
    "help_quit": "leave",
    "help_keys": "Ctrl-C or Esc Esc is the emergency stop too; Ctrl-C twice leaves.",
}

_ESTONIAN = {
    "system": "Parley",
    "you": "Sina",
    "welcome": "Räägid Parleyga. /help näitab käske, Ctrl-D lõpetab.",
    "understands": "Sinust saab aru: {name}.",
    "try": "Näiteks:",
    "goodbye": "Head aega.",
    "joined": "{robot} on kohal.",
    "left": "{robot} lahkus.",
    "lost": "Ühendus robotiga {robot} puudub.",
    "found": "Ühendus robotiga {robot} on taastunud.",
    "no_robot": "Ükski robot pole veel vastanud, seega ei saanud keegi sõnumit.",
    "selected": "Räägid nüüd robotiga {robot}.",
    "unknown_robot": "Robotit nimega {name} ei ole. Praegu on kohal: {robots}.",
    "plan_of": "{robot} kavatseb:",
    "no_plan": "Robotil {robot} pole midagi teha.",
    "proposal_of": "{robot} teeks nii:",
    "yes_or_no": "Vasta jah või ei.",
    "asks_first": "{robot} küsib enne uue plaani alustamist.",
    "runs_at_once": "{robot} alustab uusi plaane kohe.",
    "approve_usage": "/approve on: enne alustamist küsitakse; /approve off: alustatakse kohe.",
    "stop_sent": 'Hädastopp: {robot}. Et see saaks taas liikuda: /reset, seejärel "jätka".',
    "stop_sent_all": 'Hädastopp kõigile robotitele. Et nad saaksid taas liikuda: /reset all, siis "jätka".',
    "stop_received": '{robot} peatub. Et see saaks taas liikuda: /reset, seejärel "jätka".',
    "stop_at_rest": "{robot} seisab.",
    "stop_moving": "{robot} ei seisa veel.",
    "stop_silent": "{robot} ei vasta. Vaata, kas see seisab.",
    "stop_reset": '{robot} tohib taas liikuda. Jätkamiseks kirjuta "jätka".',
    "interrupt_hint": "Lahkumiseks vajuta veel kord Ctrl-C.",
    "refused_latched": "{robot} on hädastopiga peatatud. Kirjuta enne /reset.",
    "refused_message": "Seda ei saanud lugeda ja midagi ei muudetud: {problem}",
    "refused": "{robot} ei saanud seda vastu võtta ja midagi ei muudetud.",
    "memory_empty": "Midagi pole veel meeles.",
    "memory_title": "Meeles on:",
    "memory_picture": "pilt: {info}",
    "memory_unavailable": "Mälu praegu ei vasta.",
    "unknown_command": "Käsku {command} ei ole. /help näitab käske.",
    "did_you_mean": "Käsku {command} ei ole. Kas mõtlesid {suggestion}?",
    "sources": "mäletatud: {names}",
    "more_steps": "ja veel {count}",
    "state_idle": "valmis",
    "state_running": "töötab",
    "state_paused": "pausil",
    "state_held": "ootab sind",
    "state_awaiting_approval": "ootab sinu nõusolekut",
    "state_question": "ootab sinu vastust",
    "state_stopped": "peatatud, /reset lubab taas liikuda",
    "state_lost": "ühendus puudub",
    "step_queued": "ootel",
    "step_running": "praegu",
    "step_finished": "tehtud",
    "step_failed": "ei õnnestunud",
    "step_stopped": "peatatud",
    "step_skipped": "vahele jäetud",
    "step_paused": "pausil",
    "step_waiting": "ootab sind",
    "yes_words": "jah j jaa sobib olgu yes y ok",
    "no_words": "ei no n",
    "help_intro": "Kirjuta oma sõnadega, mida soovid. Nummerdatud valikutest võib valida numbriga.",
    "help_help": "näita seda",
    "help_plan": "näita plaani",
    "help_approve": "on: küsi enne plaani alustamist; off: alusta kohe",
    "help_stop": "hädastopp; all: kõik robotid",
    "help_reset": "luba pärast hädastoppi taas liikuda",
    "help_robots": "kes on kohal",
    "help_robot": "räägi teise robotiga",
    "help_memory": "näita, mis on meeles",
    "help_quit": "lahku",
    "help_keys": "Ka Ctrl-C ja Esc Esc on hädastopp; kaks korda Ctrl-C lõpetab.",
}

LANGUAGES: Mapping[str, Mapping[str, str]] = {"en": _ENGLISH, "et": _ESTONIAN}
"""Language code -> key -> text with ``{placeholders}``."""


class Texts:
    """The terminal's words in one language."""

    def __init__(self, lang: str = "en") -> None:
        self.lang = lang if lang in LANGUAGES else "en"
        self._table = LANGUAGES[self.lang]

    def __call__(self, key: str, **values: object) -> str:
        """The text of `key` with its placeholders filled in."""
        return self._table[key].format(**values)

    def words(self, key: str) -> frozenset[str]:
        """A text that is a list of words, as a set."""
        return frozenset(self._table[key].split())


def choose_language(wanted: str = "", environ: Mapping[str, str] = os.environ) -> str:
    """The code of the language to use: `wanted`, else what the environment says, else English."""
    named = wanted or environ.get("LC_ALL") or environ.get("LC_MESSAGES") or environ.get("LANG") or "en"
    code = named.split("_")[0].split(".")[0].lower()
    return code if code in LANGUAGES else "en"
