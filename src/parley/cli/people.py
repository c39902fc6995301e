"""`parley people`: accounts of a data folder, also while a system runs on it."""

from __future__ import annotations

import getpass
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Annotated, TypeVar

import typer

from parley.cli.confirm import confirm
from parley.cli.on_loop import interruptible, on_loop
from parley.cli.output import emit_json, quiet_logs
from parley.clock import WallClock
from parley.errors import ConfigError
from parley.messages.principal import ROLES, Principal, Role, person
from parley.web.people.passwords import Passwords, password_problem
from parley.web.people.records import key_of, name_problem
from parley.web.people.store import FILE, PeopleStore

__all__ = ["app"]

T = TypeVar("T")

app = typer.Typer(no_args_is_help=True)

DataOption = Annotated[Path, typer.Option("--data", "--data-dir", help="The data folder of a system.")]
NameArgument = Annotated[str, typer.Argument(help="The person's name.")]
RoleArgument = Annotated[str, typer.Argument(help=f"One of: {', '.join(ROLES)}.")]
PasswordOption = Annotated[
    Path | None, typer.Option(help="File with the password, instead of being asked for it.")
]


@app.command("add")
def add(
    name: NameArgument,
    data: DataOption,
    role: Annotated[str, typer.Option(help=f"One of: {', '.join(ROLES)}.")] = "operator",
    password_file: PasswordOption = None,
) -> None:
    """Make an account. The first one is a supervisor's; from then on everybody signs in."""
    wished = _role(role)
    if problem := name_problem(name):
        raise ConfigError(problem)
    hashed = Passwords().hashed(_password(password_file))
    given = _with_store(data, lambda store: store.add(name, wished, hashed, _me()), makes=True)
    typer.echo(f"{name} is {given} now.")
    if given != wished:
        typer.echo("The first account is a supervisor's: somebody has to make the others.")


@app.command("list")
def list_people(
    data: DataOption, json: Annotated[bool, typer.Option("--json", help="One JSON object per line.")] = False
) -> None:
    """List all accounts."""
    roll = _with_store(data, lambda store: store.roll())
    for each in roll.people.values():
        devices = sum(device.person == each.key for device in roll.devices.values())
        passkeys = sum(passkey.person == each.key for passkey in roll.passkeys.values())
        if json:
            emit_json(
                {
                    "name": each.name,
                    "role": each.role,
                    "disabled": each.disabled,
                    "devices": devices,
                    "passkeys": passkeys,
                    "seen_unix_ms": each.seen_unix_ms,
                }
            )
        else:
            more = ", disabled" if each.disabled else ""
            typer.echo(f"{each.name}: {each.role}{more}, {devices} devices, {passkeys} passkeys")


@app.command("role")
def role(name: NameArgument, role: RoleArgument, data: DataOption) -> None:
    """Give somebody another role; it counts at once."""
    wished = _role(role)
    _with_store(data, lambda store: store.set_role(name, wished, _me()))
    typer.echo(f"{name} is {wished} now.")


@app.command("password")
def password(name: NameArgument, data: DataOption, password_file: PasswordOption = None) -> None:
    """Give somebody another password; they are signed out everywhere."""
    roll = _with_store(data, lambda store: store.roll())
    if key_of(name) not in roll.people:
        raise ConfigError(f"There is no account called {name}.")
    hashed = Passwords().hashed(_password(password_file))
    _with_store(data, lambda store: store.set_password(name, hashed, _me()))
    typer.echo(f"{name} has another password now.")


@app.command("remove")
def remove(
    name: NameArgument,
    data: DataOption,
    yes: Annotated[bool, typer.Option("--yes", "-y", help="Do not ask.")] = False,
) -> None:
    """Remove an account; its devices are signed out at once."""
    confirm(f"Remove the account of {name}?", yes=yes)
    _with_store(data, lambda store: store.remove(name, _me()))
    typer.echo(f"{name} has no account any more.")


@app.command("disable")
def disable(
    name: NameArgument,
    data: DataOption,
    again: Annotated[bool, typer.Option("--undo", help="Let them in again.")] = False,
) -> None:
    """Keep somebody out; their devices are signed out at once."""
    _with_store(data, lambda store: store.set_disabled(name, not again, _me()))
    typer.echo(f"{name} {'may come in again' if again else 'is kept out'}.")


def _me() -> Principal:
    """Whoever has the folder in hand may do everything with it."""
    try:
        user = getpass.getuser()
    except (OSError, KeyError):
        user = ""
    return person(user, device="command line", role="supervisor")


def _role(text: str) -> Role:
    found = next((role for role in ROLES if role == text), None)
    if found is None:
        raise ConfigError(f"there is no role {text!r}; there are: {', '.join(ROLES)}")
    return found


def _password(file: Path | None) -> str:
    if file is not None:
        try:
            text = file.read_text(encoding="utf-8").strip()
        except (OSError, UnicodeDecodeError) as error:
            raise ConfigError(f"--password-file: {file} cannot be read: {error}") from error
    else:
        with interruptible():  # the terminal goes on showing what is typed
            text = typer.prompt("Password", hide_input=True, confirmation_prompt="Again")
    if problem := password_problem(text):
        raise ConfigError(problem)
    return text


def _with_store(data: Path, work: Callable[[PeopleStore], Awaitable[T]], *, makes: bool = False) -> T:
    quiet_logs(False)
    file = data / FILE
    if not makes and not file.exists():
        raise ConfigError(f"there are no accounts in {data}; make one: parley people add NAME --data {data}")

    async def run() -> T:
        async with await PeopleStore.open(file, WallClock()) as store:
            return await work(store)

    return on_loop(run())
