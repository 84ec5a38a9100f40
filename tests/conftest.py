"""What holds for all tests."""

from hypothesis import settings

settings.register_profile("untimed", deadline=None)  # no test measures time: a machine may be slow, a kernel uncompiled
settings.load_profile("untimed")
