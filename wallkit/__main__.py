"""``python -m wallkit`` is the ``wallkit`` command."""

from wallkit.cli import main

main()
