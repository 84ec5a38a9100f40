"""What the docs say is what happens: their code runs, and names, options and codes are all there."""

import ast
import contextlib
import importlib.util
import io
import itertools
import json
import os
import re
import runpy
import shutil
from pathlib import Path

import pytest

import wallkit

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
API = (ROOT / "docs/api.md").read_text(encoding="utf-8")
PROBLEMS = (ROOT / "docs/problems.md").read_text(encoding="utf-8")
BLOCKS = [
    pytest.param(code, id=f"{page.stem}-{number}")
    for page in PAGES
    for number, code in enumerate(re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL), 1)
]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder of somebody who has the samples and nothing else."""
    shutil.copytree(ROOT / "samples", tmp_path / "samples")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def script(name):
    """A module of docs/, which is no package."""
    spec = importlib.util.spec_from_file_location(name, ROOT / "docs" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("code", BLOCKS)
def test_every_block_of_python_runs_alone(code, folder):
    if "svgpathtools" in code:
        pytest.importorskip("svgpathtools")
    with contextlib.redirect_stdout(io.StringIO()):
        exec(compile(code, "block", "exec"), {"__name__": "block"})


@pytest.mark.parametrize("code", BLOCKS)
def test_the_docs_use_public_names_alone(code):
    """But for a page that says how the inside is changed, which shows no Python that imports it either."""
    imported = {
        module
        for node in ast.walk(ast.parse(code))
        for module in (
            [one.name for one in node.names] if isinstance(node, ast.Import) else [getattr(node, "module", "")]
        )
        if isinstance(node, ast.Import | ast.ImportFrom)
    }
    assert not {module for module in imported if module.startswith(("wallkit.", "importers"))}


@pytest.mark.parametrize("name", wallkit.__all__)
def test_every_public_name_has_its_section_with_an_example_that_uses_it(name):
    sections = dict(re.findall(r"^### (\S+)\n(.*?)(?=^##|\Z)", API.replace("\\_", "_"), re.MULTILINE | re.DOTALL))
    assert name in sections
    (code,) = re.findall(r"```python\n(.*?)```", sections[name], re.DOTALL)
    in_words = {"Drawing", "SurveyTotals", "SceneError"}  # made by others in some examples
    assert f"wallkit.{name}" in code or name in in_words


def test_the_page_of_names_has_no_others_and_their_signatures():
    names = [name.replace("\\_", "_") for name in re.findall(r"^### (\S+)$", API, re.MULTILINE)]
    assert sorted(names) == sorted(wallkit.__all__)
    assert script("make_api").filled(API) == API, "run python docs/make_api.py"


def test_the_page_of_commands_is_what_they_say_of_themselves():
    page = (ROOT / "docs/cli.md").read_text(encoding="utf-8")
    assert script("make_cli").page() == page, "run python docs/make_cli.py"


def test_dir_shows_public_names_and_nothing_else():
    assert {name for name in dir(wallkit) if not re.fullmatch("__.*__", name)} == set(wallkit.__all__) - {"__version__"}


def test_every_example_says_first_what_it_shows():
    assert len(EXAMPLES) >= 4
    for example in EXAMPLES:
        assert ast.get_docstring(ast.parse(example.read_text(encoding="utf-8"))), example.name


ALONE = [example for example in EXAMPLES if "argparse" not in example.read_text(encoding="utf-8")]
"""Those that ask for a level are run with one by the tests of the walkthroughs."""


@pytest.mark.parametrize("example", ALONE, ids=lambda path: path.stem)
def test_every_example_runs(example, folder, capsys):
    runpy.run_path(str(example), run_name="__main__")
    assert capsys.readouterr().out


# A code stands in the source as code="...", or at one place of a call that makes or collects findings.
PLACES = {
    "FindingKind": 0, "Problem": 0, "count": 0, "note": 0, "note_where": 0, "say": 0, "_report": 0,
    "problem": 1, "refused": 4,
}  # fmt: skip
SEVERITIES = {"error", "warning", "info"}


def words(node):
    return [one.value for one in ast.walk(node) if isinstance(one, ast.Constant) and isinstance(one.value, str)]


def codes_of(call):
    for keyword in call.keywords:
        if keyword.arg == "code" and not isinstance(keyword.value, ast.JoinedStr):
            yield from words(keyword.value)
    name = getattr(call.func, "attr", getattr(call.func, "id", ""))
    plain = [arg.value if isinstance(arg, ast.Constant) else None for arg in call.args]
    for arg, after in itertools.pairwise(call.args):  # a code and its severity, or one of two codes
        if isinstance(after, ast.Constant) and after.value in SEVERITIES:
            yield from words(arg) if isinstance(arg, ast.Constant) else []
            yield from words(arg.body) + words(arg.orelse) if isinstance(arg, ast.IfExp) else []
    if name == "add" and len(plain) >= 3:  # Notes.add(code, severity, ...), Found.add(wall, code, severity, ...)
        yield from (code for code, after in itertools.pairwise(plain) if code and after in SEVERITIES)
        if isinstance(call.args[0], ast.Constant):
            yield plain[0]
    elif name in PLACES and len(plain) > max(PLACES[name], 1) and isinstance(plain[PLACES[name]], str):
        yield plain[PLACES[name]]


def codes_in(node):
    if isinstance(node, ast.Call):
        yield from codes_of(node)
        if getattr(node.func, "id", "") == "told" and len(node.args) == 2:  # a pass of the repair
            yield f"repaired-{node.args[0].value}"
    elif isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "code":
        yield from words(node.value)
    elif isinstance(node, ast.Return) and isinstance(node.value, ast.Tuple) and len(node.value.elts) == 3:
        code, message, _ = node.value.elts
        yield from [code.value] if isinstance(code, ast.Constant) and isinstance(message, ast.JoinedStr) else []


def codes_of_the_source():
    from wallkit.walls.importing.choose_paths import _REASONS

    files = [path for package in ("wallkit", "importers") for path in (ROOT / package).rglob("*.py")]
    nodes = [node for path in files for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))]
    found = {str(code) for node in nodes for code in codes_in(node)} | {f"left-out-{why}" for why in _REASONS}
    return {code for code in found if re.fullmatch("[a-z]+(-[a-z]+)*", code)} - SEVERITIES


def test_every_code_of_the_source_is_told_and_no_other():
    rows = re.findall(r"^\| (`[^|]*) \|", PROBLEMS, re.MULTILINE)
    told = {code for row in rows for code in re.findall("`([a-z-]+)`", row)} - SEVERITIES
    source = codes_of_the_source()
    assert source - told == set(), "not in docs/problems.md"
    assert told - source == set(), "in docs/problems.md, but nowhere in the source"


def test_the_navigation_of_the_docs_holds_every_page_once():
    text = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
    listed = re.findall(r"[\w-]+\.md", text[text.index("\nnav:") :])
    assert sorted(listed) == sorted(page.name for page in (ROOT / "docs").glob("*.md"))


def test_the_docs_are_built_without_a_warning(tmp_path, monkeypatch):
    pytest.importorskip("mkdocs", reason="mkdocs is not installed (extra docs)")
    pytest.importorskip("material", reason="mkdocs-material is not installed (extra docs)")
    import subprocess
    import sys

    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(tmp_path / "site")]
    done = subprocess.run(
        command, cwd=ROOT, env={**os.environ, "NO_MKDOCS_2_WARNING": "1"}, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert json.loads((tmp_path / "site/search/search_index.json").read_text(encoding="utf-8"))["docs"]
