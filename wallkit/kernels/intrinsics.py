"""What one instruction of the machine, or a few, do better than what the compiler makes of Python.

Each is a function that does the same in Python, and what stands in for it in machine code.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

AT_ONCE = 8
"""Numbers looked up, or paired up, together."""
FIRST, SECOND = 3, 2
"""The caches L1 and L2, as LLVM numbers them."""


def claim(counter: Any, count: int) -> int:
    """Take the next ``count`` numbers of a counter in an array, which threads may share: the first of them."""
    first = int(counter[0])
    counter[0] += count
    return first


def prefetch(_records: Any, _place: int) -> None:
    """Prefetch an item of an array that is read soon into the L1 cache.

    It changes no result, and the place may be anywhere, also beyond the array.
    """


def prefetch_far(_records: Any, _place: int) -> None:
    """Prefetch an item into the L2 cache, where there are so many that they come from memory.

    L1 has few miss buffers, and stalls when all are in use: random cache lines come up to twice as fast through L2.
    """


def lowest(bits: int) -> int:
    """Give the place of the lowest bit that is set in an integer; there must be one."""
    # bits & -bits keeps the lowest bit, as two's complement has it.
    return (bits & -bits).bit_length() - 1


def look_up(table: Any, places: Any, first: int, found: Any, to: int) -> None:
    """Look up eight numbers of a table together: that at ``places[first + j]`` goes to ``found[to + j]``."""
    for j in range(AT_ONCE):
        found[to + j] = table[places[first + j]]


def pair_up(ids: Any, at: int, who: int, pairs: Any, to: int, to_who: int) -> None:
    """Write the next eight ids of a list one after the other, and as often who asks them."""
    for k in range(AT_ONCE):
        pairs[to + k] = ids[at + k]
        pairs[to_who + k] = who


def fetch(records: Any, ids: Any, first: int, columns: Any, to: int, step: int) -> None:
    """Turn some records into columns, as many at once as a record has floats (a power of two).

    The record of the id ``ids[first + j]`` fills place j of the columns that begin at ``to``, each ``step`` behind the
    one before: first the id, then the numbers of the record.
    """
    for j in range(len(records[0])):
        number = ids[first + j]
        columns[to + j] = float(number)
        for k, value in enumerate(records[number], 1):
            columns[to + k * step + j] = value


@cache
def register() -> None:
    """Tell Numba what stands in for these functions in machine code."""
    from numba import types
    from numba.extending import intrinsic, overload

    def stand_in(function: Callable[..., Any], in_machine_code: Callable[..., Any]) -> None:
        options: Any = {"forceinline": True, "_nrt": False}
        overload(function, jit_options=options)(in_machine_code)

    number, nothing = types.int64, types.none
    add: Any = intrinsic(lambda _context, counter, count: (number(counter, number), _emit_claim))

    def asking(cache: int) -> Any:
        return intrinsic(lambda _context, records, place: (nothing(records, types.uint64), _prefetch_to(cache)))

    ask, ask_far = asking(FIRST), asking(SECOND)
    zeros: Any = intrinsic(lambda _context, bits: (number(number), _emit_lowest))
    gather: Any = intrinsic(
        lambda _context, table, places, first, found, to: (
            nothing(table, places, number, found, number),
            _emit_look_up,
        )
    )
    turn: Any = intrinsic(
        lambda _context, records, ids, first, columns, to, step: (
            nothing(records, ids, number, columns, number, number),
            _emit_fetch,
        )
    )
    join: Any = intrinsic(
        lambda _context, ids, at, who, pairs, to, to_who: (
            nothing(ids, number, number, pairs, number, number),
            _emit_pair_up,
        )
    )
    stand_in(claim, lambda counter, count: lambda counter, count: add(counter, count))
    stand_in(prefetch, lambda records, place: lambda records, place: ask(records, place))
    stand_in(prefetch_far, lambda records, place: lambda records, place: ask_far(records, place))
    stand_in(lowest, lambda bits: lambda bits: zeros(bits))
    stand_in(look_up, lambda a, b, c, d, e: lambda a, b, c, d, e: gather(a, b, c, d, e))
    stand_in(pair_up, lambda a, b, c, d, e, f: lambda a, b, c, d, e, f: join(a, b, c, d, e, f))
    stand_in(fetch, lambda a, b, c, d, e, f: lambda a, b, c, d, e, f: turn(a, b, c, d, e, f))


def _place_in(context: Any, builder: Any, kind: Any, array: Any, index: Any) -> Any:
    """Emit the address of an item of an array."""
    from numba.np.arrayobj import make_array

    if index.type.width < 64:
        index = builder.zext(index, index.type.__class__(64))
    return builder.gep(make_array(kind)(context, builder, array).data, [index])


def _emit_claim(context: Any, builder: Any, signature: Any, values: Any) -> Any:
    """Count without a gap between reading and writing: no two threads take the same number."""
    from llvmlite import ir

    # Monotonic: each number once, and no order with other memory, which threads do not share while they fly.
    place = _place_in(context, builder, signature.args[0], values[0], ir.IntType(64)(0))
    return builder.atomic_rmw("add", place, values[1], "monotonic")


def _prefetch_to(cache: int) -> Any:
    """Return what emits a prefetch into the FIRST cache or the SECOND."""

    def emit(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        from llvmlite import ir
        from numba.core import cgutils

        word, byte = ir.IntType(32), ir.IntType(8).as_pointer()
        kind = ir.FunctionType(ir.VoidType(), [byte, word, word, word])
        function = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch")
        place = _place_in(context, builder, signature.args[0], *values)
        # llvm.prefetch(address, 0 to read, locality, 1 for data).
        builder.call(function, [builder.bitcast(place, byte), word(0), word(cache), word(1)])  # to read
        return context.get_dummy_value()

    return emit


def _emit_lowest(_context: Any, builder: Any, _signature: Any, values: Any) -> Any:
    from llvmlite import ir

    # Count of trailing zeros; the flag says that nobody asks for those of 0.
    return builder.cttz(values[0], ir.IntType(1)(1))


def _emit_look_up(context: Any, builder: Any, signature: Any, values: Any) -> Any:
    """One load for each number, and one store for all."""
    from llvmlite import ir

    word = ir.IntType(32)
    (table, places, _first, found, _to), (numbers, which, first, written, to) = signature.args, values
    together = ir.VectorType(word, AT_ONCE)(ir.Undefined)
    # Eight loads that wait for one another's caches together, where a loop would wait eight times.
    for j in range(AT_ONCE):
        at = builder.load(_place_in(context, builder, places, which, builder.add(first, first.type(j))))
        number = builder.load(_place_in(context, builder, table, numbers, at))
        together = builder.insert_element(together, builder.zext(number, word), word(j))
    place = _place_in(context, builder, found, written, to)
    builder.store(together, builder.bitcast(place, together.type.as_pointer()), align=4)
    return context.get_dummy_value()


def _emit_pair_up(context: Any, builder: Any, signature: Any, values: Any) -> Any:
    """One load for the ids, and two stores."""
    from llvmlite import ir

    together = ir.VectorType(ir.IntType(32), AT_ONCE)
    (table, _at, _who, pairs, _to, _to_who), (ids, at, who, written, to, to_who) = signature.args, values
    # Ids lie side by side: one vector load, of as many as may be there; what is too much is not counted.
    place = _place_in(context, builder, table, ids, at)
    found = builder.load(builder.bitcast(place, together.as_pointer()), align=4)
    ball = builder.insert_element(together(ir.Undefined), builder.trunc(who, together.element), together.element(0))
    ball = builder.shuffle_vector(ball, ball, ir.Constant(together, [0] * AT_ONCE))
    for numbers, first in ((found, to), (ball, to_who)):
        place = _place_in(context, builder, pairs, written, first)
        builder.store(numbers, builder.bitcast(place, together.as_pointer()), align=4)
    return context.get_dummy_value()


def _emit_fetch(context: Any, builder: Any, signature: Any, values: Any) -> Any:
    """One load for each record, and one store for each column."""
    from llvmlite import ir

    word, kinds = ir.IntType(32), signature.args
    table, names, first, columns, to, step = values
    size = kinds[0].dtype.size // 8
    floats = ir.VectorType(ir.DoubleType(), size)
    found, rows = ir.VectorType(word, size)(ir.Undefined), []
    # A record is one cache line: whole rows are loaded, and turned into columns in registers.
    for j in range(size):
        number = builder.load(_place_in(context, builder, kinds[1], names, builder.add(first, first.type(j))))
        found = builder.insert_element(found, number, word(j))
        row = _place_in(context, builder, kinds[0], table, builder.zext(number, first.type))
        rows.append(builder.load(builder.bitcast(row, floats.as_pointer()), align=8))
    for k, column in enumerate([builder.uitofp(found, floats), *_transposed(builder, rows)]):
        place = _place_in(context, builder, kinds[3], columns, builder.add(to, builder.mul(step, step.type(k))))
        builder.store(column, builder.bitcast(place, floats.as_pointer()), align=8)
    return context.get_dummy_value()


def _transposed(builder: Any, rows: list[Any]) -> list[Any]:
    """Emit what turns n vectors of n numbers into columns: blocks of 1, 2, 4, ... beside the diagonal change places."""
    from llvmlite import ir

    size, block = len(rows), 1
    while block < size:
        # Index `block` of row and of column change places: after log2 n rounds all of them have.
        low = [k if k & block == 0 else size + k - block for k in range(size)]
        high = [k + block if k & block == 0 else size + k for k in range(size)]
        masks = [ir.Constant(ir.VectorType(ir.IntType(32), size), order) for order in (low, high)]
        rows = [
            builder.shuffle_vector(rows[j & ~block], rows[j | block], masks[1 if j & block else 0]) for j in range(size)
        ]
        block *= 2
    return rows
