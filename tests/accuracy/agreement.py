"""The simulator against the reference of contact states, at the end of a run."""

import numpy as np

from wallkit import simulate
from wallkit.accuracy.reference_contact import ContactReference


def assert_ends_as_the_reference(scene, until):
    """To 1e-9 in place and velocity, or the horizon says that the run is not good to that."""
    run = simulate(scene, until=until)
    off = np.abs(np.array(run.final[0].tolist()) - np.array(ContactReference(scene).run(until)[-1].row()))
    assert off[1:].max() <= 1e-9 or not run.trusted_until(1e-9)[0].whole
