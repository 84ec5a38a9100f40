"""What stands in for the functions of ``intrinsics`` in machine code: one instruction, or a few."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from wallkit.kernels import intrinsics
from wallkit.kernels.compiler.emitter import Emitter, Maybe
from wallkit.kernels.compiler.memory import kind_of, unchecked_place
from wallkit.kernels.compiler.values import INT, NATURAL, NONE, UnknownError, Value
from wallkit.kernels.intrinsics import AT_ONCE, FIRST, SECOND

TOGETHER = f"<{AT_ONCE} x i32>"
NOTHING = Value(NONE, ())


def _index(to: Emitter, of: Maybe, more: int = 0) -> str:
    leaf = to.whole(of).leaves[0]
    return to.emit(f"add i64 {leaf}, {more}") if more else leaf


def _read(to: Emitter, array: Value, index: str) -> tuple[str, str]:
    """Load a number: LLVM's type, and the number."""
    kind = kind_of(array.type.dtype)
    return kind, to.emit(f"load {kind}, ptr {unchecked_place(to, array, index)}")


def _read_index(to: Emitter, array: Value, index: str) -> str:
    kind, number = _read(to, array, index)
    return number if kind == "i64" else to.emit(f"zext {kind} {number} to i64")


def _claim(to: Emitter, counter: Value, count: Maybe) -> Value:
    """Count without a gap between reading and writing: no two threads take the same number."""
    # Monotonic: each number once, and no order with other memory, which threads do not share while they fly.
    place = unchecked_place(to, counter, "0")
    return Value(INT, (to.emit(f"atomicrmw add ptr {place}, i64 {_index(to, count)} monotonic"),))


def _prefetch_to(cache: int) -> Callable[..., Value]:
    """Return what emits a prefetch into the FIRST cache or the SECOND."""

    def emit(to: Emitter, records: Value, place: Maybe) -> Value:
        address = unchecked_place(to, records, _index(to, place))
        # llvm.prefetch(address, 0 to read, locality, 1 for data).
        to.call("llvm.prefetch.p0", "void", f"ptr {address}", "i32 0", f"i32 {cache}", "i32 1")
        return NOTHING

    return emit


def _lowest(to: Emitter, bits: Maybe) -> Value:
    # Count of trailing zeros; the flag says that nobody asks for those of 0.
    return Value(NATURAL, (to.call("llvm.cttz.i64", "i64", f"i64 {_index(to, bits)}", "i1 true"),))


def _look_up(to: Emitter, table: Value, places: Value, first: Maybe, found: Value, where: Maybe) -> Value:
    """One load for each number, and one store for all."""
    together = "poison"
    # Eight loads that wait for one another's caches together, where a loop would wait eight times.
    for j in range(AT_ONCE):
        kind, number = _read(to, table, _read_index(to, places, _index(to, first, j)))
        number = number if kind == "i32" else to.emit(f"zext {kind} {number} to i32")
        together = to.emit(f"insertelement {TOGETHER} {together}, i32 {number}, i32 {j}")
    to.do(f"store {TOGETHER} {together}, ptr {unchecked_place(to, found, _index(to, where))}, align 4")
    return NOTHING


def _pair_up(to: Emitter, ids: Value, at: Maybe, who: Maybe, pairs: Value, where: Maybe, where_who: Maybe) -> Value:
    """One load for the ids, and two stores."""
    # Ids lie side by side: one vector load, of as many as may be there; what is too much is not counted.
    found = to.emit(f"load {TOGETHER}, ptr {unchecked_place(to, ids, _index(to, at))}, align 4")
    one = to.emit(f"insertelement {TOGETHER} poison, i32 {to.emit(f'trunc i64 {_index(to, who)} to i32')}, i32 0")
    ball = to.emit(f"shufflevector {TOGETHER} {one}, {TOGETHER} poison, {TOGETHER} zeroinitializer")
    for numbers, first in ((found, where), (ball, where_who)):
        to.do(f"store {TOGETHER} {numbers}, ptr {unchecked_place(to, pairs, _index(to, first))}, align 4")
    return NOTHING


def _fetch(
    to: Emitter, records: Value, ids: Value, first: Maybe, columns: Value, where: Maybe,
    wanted: tuple[tuple[int, int], ...],
) -> Value:  # fmt: skip
    """One load for each record, and one store for each column."""
    size = records.type.dtype.itemsize // 8
    floats, words = f"<{size} x double>", f"<{size} x i32>"
    if ids.type.dtype.itemsize != 4:
        raise UnknownError("ids of another size")
    # A record is one cache line: whole rows are loaded, and turned into columns in registers.
    found = to.emit(f"load {words}, ptr {unchecked_place(to, ids, _index(to, first))}, align 4")
    rows = [
        to.emit(
            f"load {floats}, ptr {unchecked_place(to, records, _read_index(to, ids, _index(to, first, j)))}, align 8"
        )
        for j in range(size)
    ]
    numbers = [to.emit(f"uitofp {words} {found} to {floats}"), *_transposed(to, floats, rows)]
    for k, begin in wanted:  # LLVM leaves out what nobody wants
        place = unchecked_place(to, columns, _index(to, where, begin))
        to.do(f"store {floats} {numbers[k]}, ptr {place}, align 8")
    return NOTHING


def _transposed(to: Emitter, floats: str, rows: list[str]) -> list[str]:
    """Emit what turns n vectors of n numbers into columns: blocks of 1, 2, 4, ... beside the diagonal change places."""
    size, block = len(rows), 1
    while block < size:
        # Index `block` of row and of column change places: after log2 n rounds all of them have.
        low = [k if k & block == 0 else size + k - block for k in range(size)]
        high = [k + block if k & block == 0 else size + k for k in range(size)]
        masks = [f"<{size} x i32> <{', '.join(f'i32 {k}' for k in order)}>" for order in (low, high)]
        rows = [
            to.emit(
                f"shufflevector {floats} {rows[j & ~block]}, {floats} {rows[j | block]}, {masks[1 if j & block else 0]}"
            )
            for j in range(size)
        ]
        block *= 2
    return rows


INSTRUCTIONS: dict[Any, Callable[..., Value]] = {
    intrinsics.claim: _claim,
    intrinsics.prefetch: _prefetch_to(FIRST),
    intrinsics.prefetch_far: _prefetch_to(SECOND),
    intrinsics.lowest: _lowest,
    intrinsics.look_up: _look_up,
    intrinsics.pair_up: _pair_up,
    intrinsics.fetch: _fetch,
}
