import io

from importers.errors import DrawingError
from importers.excerpts import WIDTH, excerpt
from importers.problems import Problem
from wallkit.cli.messages import count_by_severity, format_problem, show_error, show_problems, use_colour


class Terminal(io.StringIO):
    def isatty(self):
        return True


def a_problem(number=1, severity="warning", code="open-path"):
    return Problem(code, severity, f"path {number} is open", fix="close it", line=number, column=3, x=1.5, y=number)


def test_a_finding_names_place_severity_code_text_caret_drawing_coordinates_and_help():
    line = '<path id="a" d="M10 10 L 20"/>'
    problem = Problem(
        "bad-path-data",
        "error",
        "a number is missing",
        fix="complete the pair",
        layer="Walls",
        name="a",
        line=3,
        column=28,
        x=10.0,
        y=10.0,
        excerpt=excerpt(line, 28),
    )
    assert format_problem(problem, "room.svg").splitlines() == [
        "room.svg:3:28: error[bad-path-data] a number is missing",
        f"    3 | {line}",
        "      | " + " " * 27 + "^",
        '  = at: (10, 10), on layer "Walls", object "a"',
        "  = help: complete the pair",
    ]


def test_the_caret_of_a_line_too_long_for_the_screen_stands_under_the_same_character():
    line = "".join(chr(0x21 + i % 90) for i in range(5000))
    for column in (1, 2, 49, 50, 51, 2500, 4950, 4999, 5000):
        text, caret = excerpt(line, column).split("\n")
        assert len(text) <= WIDTH + 2
        assert text[caret.index("^")] == line[column - 1]


def test_a_bare_line_as_excerpt_gets_its_caret_from_the_column():
    problem = Problem("odd", "info", "odd", line=1, column=4, excerpt="abcdef")
    assert format_problem(problem).splitlines()[1:] == ["    1 | abcdef", "      |    ^"]


def test_a_long_list_is_grouped_by_code_with_counts_and_first_places_the_severe_first():
    stream = io.StringIO()
    show_problems([a_problem(n) for n in range(1, 251)] + [a_problem(9, "error", "gap")], "a.svg", stream)
    text = stream.getvalue()
    assert text.index("error[gap]") < text.index("warning[open-path]")
    assert "250 times" in text
    assert "line:1:3, (1.5, 1)" in text
    assert "247 more" in text
    assert len(text.splitlines()) < 12
    assert text.splitlines()[-1] == "1 error, 250 warnings"


def test_a_short_list_shows_each():
    stream = io.StringIO()
    show_problems([a_problem(1), a_problem(2)], "a.svg", stream)
    assert stream.getvalue().count("open-path") == 2


def test_nothing_is_written_without_findings():
    stream = io.StringIO()
    show_problems([], "a.svg", stream)
    assert stream.getvalue() == ""
    assert count_by_severity([]) == "no problems"


def test_colour_only_on_a_terminal_and_as_the_environment_says(monkeypatch):
    for name in ("NO_COLOR", "FORCE_COLOR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("TERM", "xterm")
    assert use_colour(Terminal())
    assert not use_colour(io.StringIO())
    monkeypatch.setenv("FORCE_COLOR", "1")
    assert use_colour(io.StringIO())
    monkeypatch.setenv("NO_COLOR", "1")
    assert not use_colour(Terminal())


def test_an_error_that_ends_the_command_has_the_same_form():
    stream = io.StringIO()
    show_error(DrawingError("not a drawing", code="not-a-drawing", fix="save as SVG", file="x.png"), stream)
    assert stream.getvalue().splitlines() == ["x.png: error[not-a-drawing] not a drawing", "  = help: save as SVG"]


def test_a_layer_name_cannot_drive_the_terminal():
    text = format_problem(Problem("a", "info", "b", layer="\x1b[2J\x07"))
    assert "\x1b" not in text
    assert "\\x1b[2J" in text
