"""Write docs/cli.md from what the commands say of themselves: python docs/make_cli.py, from the repository's root."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import typer.main

from wallkit.cli import app as cli

PAGE = Path(__file__).parent / "cli.md"
HEAD = """# The commands and their options

Made by `python docs/make_cli.py` from the commands' own help. FILE is a drawing, walls or a scene, told by its content;
`-` stands for standard input or output. Exit codes: 0 fine, 1 findings (`wallkit check`), 2 unreadable input or wrong
usage, 3 a limit was hit, 130 interrupted.
"""


def page() -> str:
    """Write the page: a section a command, a table row an option."""
    cli._register_commands()
    group: Any = typer.main.get_command(cli.app)
    return "\n".join([HEAD, *(_section(name, command) for name, command in group.commands.items())])


def _section(name: str, command: Any) -> str:
    arguments = [one for one in command.params if one.param_type_name == "argument"]
    options = [one for one in command.params if one.param_type_name == "option"]
    usage = " ".join(["wallkit", name, *(_argument(one) for one in arguments), "[OPTIONS]"])
    lines = [f"## wallkit {name}", "", _plain(command.help), "", "```sh", usage, "```", ""]
    lines += ["| option | what it does |", "|---|---|"]
    lines += [f"| {_names(one)} | {_plain(one.help)}{_usual(one)} |" for one in [*arguments, *options]]
    return "\n".join(lines) + "\n"


def _argument(one: Any) -> str:
    word = (one.metavar or one.name.upper()).strip("{}[]")
    many = "..." if one.nargs != 1 else ""
    return f"{word}{many}" if one.required else f"[{word}]{many}"


def _names(one: Any) -> str:
    if one.param_type_name == "argument":
        return f"`{_argument(one)}`"
    names = ", ".join(f"`{name}`" for name in [*one.opts, *one.secondary_opts])
    return f"{names} `{_cell(one.metavar)}`" if one.metavar else names


def _usual(one: Any) -> str:
    usual = one.default
    if usual is None or isinstance(usual, bool) or callable(usual) or usual in ("", (), []):
        return ""
    return f" Usually `{_cell(str(usual))}`."


def _plain(text: str | None) -> str:
    return _cell(" ".join((text or "").replace("\b", "").split()))


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("[", "\\[").replace("<", "\\<")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
