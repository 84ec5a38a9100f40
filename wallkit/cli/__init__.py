"""The command line: one module a command. It talks to people and holds no physics."""

from wallkit.cli.app import main

__all__ = ["main"]
