"""Run one extension, as Inkscape asks: options, then the document's file; the changed document to standard output."""

import sys

from wallkit.inkscape.effects import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
