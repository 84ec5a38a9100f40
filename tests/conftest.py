"""What holds for all tests."""

import sys

import pytest
from hypothesis import settings

settings.register_profile("untimed", deadline=None)  # no test measures time: a machine may be slow, a kernel uncompiled
settings.load_profile("untimed")


@pytest.fixture
def said(monkeypatch, capsys):
    """Run the command line in this process; give (exit code, standard output, standard error)."""

    def run(*words):
        from wallkit.cli import main

        monkeypatch.setattr(sys, "argv", ["wallkit", *map(str, words)])
        try:
            main()
            code = 0
        except SystemExit as ended:
            code = ended.code or 0
        spoken = capsys.readouterr()
        return code, spoken.out, spoken.err

    return run
