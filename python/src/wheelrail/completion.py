"""Command line: a parser that says what was meant, and what a shell needs to complete commands and options."""

import argparse
import difflib
import re
from typing import NoReturn

SHELLS = ("bash", "zsh", "fish")
BASH = """_wheelrail() {{
    local word="${{COMP_WORDS[COMP_CWORD]}}"
    COMPREPLY=()
    if [ "$COMP_CWORD" -eq 1 ]; then
        COMPREPLY=($(compgen -W "{commands}" -- "$word"))
        return
    fi
    case "${{COMP_WORDS[1]}}" in
{cases}
    esac
}}
complete -o default -F _wheelrail wheelrail
"""
CASE = """        {command}) COMPREPLY=($(compgen -W "{words}" -- "$word")) ;;"""


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
    near = difflib.get_close_matches(word, [str(name) for name in known], n=1, cutoff=0.7)
    return f"; did you mean {near[0]}?" if near else ""


def _called(action: argparse.Action) -> str:
    """The name by which argparse speaks of an argument."""
    return "/".join(action.option_strings) or str(action.metavar or action.dest)


def options_of(parser: argparse.ArgumentParser) -> dict[str, list[str]]:
    """Words that may follow each command: its options, and the choices of its arguments. The parser's own are those of ``."""
    commands = {"": parser}
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            commands |= action.choices
    return {name: _words(command) for name, command in commands.items()}


def _words(parser: argparse.ArgumentParser) -> list[str]:
    """Options of a parser and choices of its positional arguments."""
    words = []
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            continue
        words += action.option_strings or [str(choice) for choice in action.choices or ()]
    return words


def script(parser: argparse.ArgumentParser, shell: str) -> str:
    """The text that a shell reads to complete `wheelrail`: bash and zsh by one function, fish by a line for each word."""
    options = options_of(parser)
    own = options.pop("")
    if shell == "fish":
        lines = [f"complete -c wheelrail -n __fish_use_subcommand -a {command}" for command in options]
        for command, words in options.items():
            seen = f"complete -c wheelrail -n '__fish_seen_subcommand_from {command}'"
            lines += [f"{seen} -l {word[2:]}" if word.startswith("--") else f"{seen} -a {word}" for word in words if word != "-h"]
        return "\n".join(lines) + "\n"
    cases = "\n".join(CASE.format(command=command, words=" ".join(words)) for command, words in options.items())
    text = BASH.format(commands=" ".join([*options, *own]), cases=cases)
    return text if shell == "bash" else f"autoload -U +X bashcompinit && bashcompinit\n{text}"


def add_command(commands: argparse._SubParsersAction) -> None:
    """Adds the command to those of `wheelrail`."""
    command = commands.add_parser("completion", help="what a shell reads to complete commands and options")
    command.add_argument("shell", choices=SHELLS)
