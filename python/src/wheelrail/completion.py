"""Command line: a parser that says what was meant, and what a shell needs to complete commands and options."""

import argparse
import re
from pathlib import Path
from typing import NoReturn

from .tables import nearest

SHELLS = ("bash", "zsh", "fish")


class Parser(argparse.ArgumentParser):
    """A parser whose refusals of commands, choices and options name the nearest known one. `wanted` is the command of the line."""

    wanted = ""

    def error(self, message: str) -> NoReturn:
        """Ends the program with a refusal, which argparse words."""
        super().error(message + meant(message, self))


def meant(message: str, parser: Parser) -> str:
    """The end of a refusal of argparse: the nearest known word to the one that is refused, if there is one."""
    choice = re.search(r"invalid choice: '([^']*)'", message)
    options = re.search(r"unrecognized arguments: (.*)", message)
    if choice:
        known = next((a.choices for a in parser._actions if a.choices and f"argument {_called(a)}:" in message), ())
        word = choice[1]
    elif options:
        known, word = options_of(parser).get(parser.wanted, ()), options[1].split()[0].partition("=")[0]
    else:
        return ""
    return nearest(word, map(str, known), likeness=0.7)


def _called(action: argparse.Action) -> str:
    """The name by which argparse speaks of an argument."""
    return "/".join(action.option_strings) or str(action.metavar or action.dest)


def _commands(parser):
    """The parser of each command; the whole one is that of ``."""
    subparsers = next(action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    return {"": parser} | subparsers.choices


def options_of(parser: argparse.ArgumentParser) -> dict[str, list[str]]:
    """Words that may follow each command: its options, and the choices of its arguments. The parser's own are those of ``."""
    words = lambda action: action.option_strings or [str(choice) for choice in action.choices or ()]
    plain = lambda command: (action for action in command._actions if not isinstance(action, argparse._SubParsersAction))
    return {name: [word for action in plain(command) for word in words(action)] for name, command in _commands(parser).items()}


def script(parser: argparse.ArgumentParser, shell: str) -> str:
    """The text that a shell reads to complete `wheelrail`."""
    import shtab

    for command in _commands(parser).values():
        for action in command._actions:
            if action.type is Path:
                action.complete = shtab.FILE
    parser.prog = "wheelrail"
    return shtab.complete(parser, shell) + "\n"


def add_command(commands: argparse._SubParsersAction) -> None:
    """Adds the command to those of `wheelrail`."""
    command = commands.add_parser("completion", help="what a shell reads to complete commands and options")
    command.add_argument("shell", choices=SHELLS)
