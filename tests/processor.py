"""How slow this processor is, for bounds on time that are stated for another one: see docs/performance.md."""

import time

STEPS = 50_000
STATED = 0.018  # seconds that these steps take on the processor for which the bounds are stated


def slowness() -> float:
    """Give how many times as long as there the steps of a reader take here and now; 1 where they take no longer."""
    start = time.process_time()
    words: dict[str, int] = {}
    for number in range(STEPS):
        name = f"a{number % 1000}"
        words[name] = words.get(name, 0) + len(name)
    return max(1.0, (time.process_time() - start) / STATED)
