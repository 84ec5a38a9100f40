"""The version of wallkit, said here alone: the package, the wheel and the command line read it."""

__version__ = "0.2.0.dev0"
