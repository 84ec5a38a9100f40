"""Kernels of modules that are imported after something was compiled are known to the compiler too."""

from wallkit.kernels.jit import compiled, kernel


@kernel
def twice(x):
    return 2.0 * x


def test_a_kernel_marked_after_the_first_compiling_is_called():
    assert compiled(twice)(1.5) == 3.0

    @kernel
    def plus_one(x):
        return x + 1.0

    @kernel
    def both(x):
        return plus_one(x) + 1.0

    assert compiled(both)(1.5) == 3.5
