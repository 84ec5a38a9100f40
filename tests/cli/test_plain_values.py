"""Plain values reach a command as Typer itself gives them, and nothing is imported that would convert them."""

import os
import subprocess
import sys
from typing import Annotated, Literal

import pytest
import typer
from typer.testing import CliRunner

from wallkit.cli.plain_values import PlainCommand, PlainGroup


def said(plain, words):
    """How a command ends and what it is given, by the classes for plain values or by Typer's own."""
    given = {}
    classes = {"cls": PlainGroup} if plain else {}
    app = typer.Typer(pretty_exceptions_enable=False, **classes)

    @app.callback()
    def root(quiet: Annotated[bool, typer.Option("--quiet", callback=lambda value: value)] = False) -> None: ...

    @app.command("act", **({"cls": PlainCommand} if plain else {}))
    def act(
        file: Annotated[str, typer.Argument()],
        name: Annotated[str, typer.Option()] = "",
        page: Annotated[str | None, typer.Option()] = None,
        ball: Annotated[list[str] | None, typer.Option()] = None,
        place: Annotated[tuple[float, float], typer.Option()] = (0.0, 1.0),
        scale: Annotated[float, typer.Option(min=0.5)] = 1.0,
        count: Annotated[int | None, typer.Option()] = None,
        way: Annotated[Literal["lines", "arcs"], typer.Option()] = "arcs",
        heat: Annotated[bool, typer.Option("--heat")] = False,
        meeting: Annotated[bool | None, typer.Option("--meeting/--no-meeting")] = None,
    ) -> None:
        given.update({key: value for key, value in locals().items() if key != "given"})

    result = CliRunner().invoke(app, words)
    return result.exit_code, result.output, {key: repr(value) for key, value in given.items()}


@pytest.mark.parametrize(
    "words",
    [
        "act a.svg",
        "--quiet act a.svg",
        "act a.svg --name x --page 2 --ball 1,2 --ball 3,4",
        "act a.svg --scale 2 --count 3 --way lines --heat --no-meeting --place 3 4",
        "act a.svg --scale 1e-1",
        "act a.svg --scale 5e-1 --count -7",
        "act a.svg --scale 0.30000000000000004e1 --count +12",
        "act a.svg --scale inf",
        "act a.svg --scale nan",
        "act a.svg --scale 1_0",
        "act a.svg --scale .5",
        "act a.svg --count 99999999999999999999",
        "act a.svg --count 0x10",
        "act a.svg --count 007",
        "act a.svg --count \u0661",
        "act a.svg --way ARCS",
        "act 1 --name 2 --meeting",
        "act",
        "act a.svg --scale 0.1",
        "act a.svg --scale x",
        "act a.svg --count 1.5",
        "act a.svg --way lives",
        "act a.svg --page",
        "act a.svg --nothing",
        "act --help",
        "--help",
        "other",
    ],
)
def test_a_command_is_given_what_typer_gives_it(words):
    assert said(True, words.split()) == said(False, words.split())


@pytest.mark.parametrize(
    "words",
    [
        ["samples/lagoon.ai", "--ball", "396,150", "--radius", "2.5", "--bounces", "20", "--no-meeting"],
        ["samples/room.svg", "--bounces", "50"],  # with contacts at corners, which the horizon looks up
    ],
)
def test_a_small_simulation_imports_nothing_heavy(words):
    late = "{'pydantic', 'rich', 'llvmlite', 'scipy', 'numpy.ma', 'PIL', 'json'}"
    code = (
        f"import sys; sys.argv = ['wallkit', 'simulate', *{words}]\n"
        "from wallkit.cli import main\n"
        "try: main()\n"
        f"finally: print({late} & set(sys.modules), file=sys.stderr)\n"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    assert result.stderr.splitlines()[-1] == "set()"


@pytest.mark.skipif(sys.platform != "linux", reason="nothing tells how many threads there are")
def test_a_command_begins_no_threads_for_matrices():
    # Of OpenBLAS, as it is imported with NumPy; Linux tells how many threads a process has.
    code = (
        "import sys; sys.argv = ['wallkit', 'simulate', 'samples/room.svg', '--bounces', '5']\n"
        "from wallkit.cli import main\n"
        "try: main()\n"
        "finally: print(open('/proc/self/status').read().partition('Threads:')[2].split()[0], file=sys.stderr)\n"
    )
    environment = {name: value for name, value in os.environ.items() if not name.endswith("_NUM_THREADS")}
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)
    assert result.stderr.splitlines()[-1] == "1", result.stderr
