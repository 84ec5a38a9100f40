"""Every case of the hard suite holds; ``wallkit report --hard`` shows the same."""

import pytest

from wallkit.accuracy.cases import all_cases

CASES = all_cases()


def test_names_are_unique():
    assert len({case.name for case in CASES}) == len(CASES)


@pytest.mark.parametrize("case", CASES, ids=[f"{case.group}: {case.name}" for case in CASES])
def test_a_known_answer(case):
    outcome = case.check()
    assert outcome.error <= outcome.tolerance, f"expected {outcome.expected}, got {outcome.got} ({outcome.why})"
