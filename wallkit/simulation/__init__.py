"""From a scene to a run: what is modelled, how it flies, what is kept of it."""
