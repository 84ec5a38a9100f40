# What one does every day; `just` lists it.
python := ".venv/bin/python"

default:
    @just --list

# A virtual environment with everything that development needs.
setup:
    python3 -m venv .venv
    .venv/bin/pip install -e '.[dev]'

# The tests; `just test tests/walls` for a part of them.
test *what:
    {{python}} -m pytest -q {{what}}

# Lint, format, types, import contracts.
lint:
    .venv/bin/ruff check .
    .venv/bin/ruff format --check .
    .venv/bin/mypy
    .venv/bin/lint-imports

# The documentation, into site/; the pages that the code writes are renewed first.
docs:
    {{python}} docs/make_api.py
    {{python}} docs/make_cli.py
    NO_MKDOCS_2_WARNING=1 {{python}} -m mkdocs build --strict

# Speed, as ratios within one run.
bench:
    {{python}} -m pytest -q benchmarks

# All that a submission is judged by.
ci:
    bash .ci/run
