"""The command line as a whole: quick to answer, and ended by words and a code whatever happens."""

import subprocess
import sys

import typer.main
from typer.testing import CliRunner

from wallkit.cli import app as cli

HEAVY = ("llvmlite", "scipy", "svgpathtools", "pikepdf", "shapely", "PIL", "lxml")


def run(*arguments, code=None):
    words = ["-m", "wallkit", *arguments] if code is None else ["-c", code]
    return subprocess.run([sys.executable, *words], capture_output=True, text=True, timeout=60)


def test_help_loads_nothing_heavy():
    code = (
        "import sys; sys.argv = ['wallkit', '--help']; from wallkit.cli import main\n"
        "try: main()\n"
        f"finally: print(sorted(set({HEAVY!r}) & set(sys.modules)), file=sys.stderr)"
    )
    result = run(code=code)
    assert result.returncode == 0
    assert all(command in result.stdout for command in ("inspect", "import", "check", "simulate", "report", "play"))
    assert result.stderr.strip() == "[]"


def test_help_shows_every_word_that_the_options_say_of_themselves():
    cli._register_commands()
    for name, command in typer.main.get_command(cli.app).commands.items():
        shown = set(CliRunner().invoke(cli.app, [name, "--help"], env={"COLUMNS": "300"}).stdout.split())
        for option in command.params:  # the terminal's writer takes [words in brackets] for a style
            assert set((option.help or "").split()) <= shown, (name, option.name)


def test_a_missing_file_is_told_in_words():
    result = run("import", "no-such-drawing.ai")
    assert result.returncode == 2
    assert "no-such-drawing.ai" in result.stderr
    assert "Traceback" not in result.stderr


def test_an_unknown_option_is_a_usage_error():
    assert run("simulate", "--no-such-option").returncode == 2


def test_a_reader_that_has_seen_enough_is_no_error(tmp_path):
    drawing = tmp_path / "many.txt"
    drawing.write_text("".join(f"{i} 0 m\n{i} 1 l\nS\n" for i in range(5000)))
    pipe = subprocess.run(
        f'"{sys.executable}" -m wallkit import "{drawing}" 2>&1 >/dev/null | head -n 1',
        shell=True,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert "Traceback" not in pipe.stdout + pipe.stderr
