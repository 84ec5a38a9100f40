"""Machine code on the disk: written once a kernel was compiled, loaded by LLVM alone and called by its address.

Neither needs Numba, of which the import and the loading of its own caches take longer than many a survey.
"""

from __future__ import annotations

import contextlib
import ctypes
import hashlib
import json
import os
import struct
import sys
import threading
import zlib
from collections.abc import Callable, Iterator
from functools import cache
from itertools import accumulate, pairwise
from pathlib import Path
from typing import Any, NamedTuple

from wallkit.kernels.signatures import Kind, result_from, result_type, word_formats

FINE = (0, -2)
"""What a kernel's call returns when nothing was raised: it has a result, or it has none."""
WORD = 8
"""Bytes of a word."""
MOST_WAITING = 100
"""Processes that may go before one that waits for a lock: beyond, or where links are not counted, it does not wait."""
SILENT = ("NUMBA_CACHE_DIR", "NUMBA_DISABLE_JIT", "NUMBA_NUM_THREADS")
"""Settings of Numba that make no difference to machine code."""


class Code(NamedTuple):
    """Machine code of a kernel for arguments of some kinds.

    Attributes:
        symbol: name of the function that takes the address of the words, see :func:`entry_of`.
        result: kind of what it returns, see ``signatures.result_of``.
        images: object files, as bytes: of the kernel, and of that function.
        needs: names of functions and variables that the process must provide, see :func:`needs_of`.
    """

    symbol: str
    result: Any
    images: tuple[bytes, ...]
    needs: tuple[str, ...]


def file_of(folder: Path, entry: Callable[..., Any], kinds: tuple[Kind, ...]) -> Path:
    """Name the file of a kernel's machine code, in a folder of what is made for one processor."""
    digest = hashlib.sha256(repr(kinds).encode()).hexdigest()
    return folder / f"{entry.__module__.rpartition('.')[2]}.{entry.__qualname__}-{digest[:24]}.code"


@cache
def sources() -> str:
    """Give the digest of all kernels' sources: a kernel changes with those that it calls, and with how it is called."""
    digest = hashlib.sha256()
    folder = Path(__file__).parent
    for path in sorted(folder.rglob("*.py")):  # kernels live in subfolders too
        digest.update(path.relative_to(folder).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


@cache
def processor() -> str:
    """Name what machine code is made for here: a digest of the processor, and of what may have been set for Numba."""
    import llvmlite
    from llvmlite import binding

    told = settings()
    with contextlib.suppress(RuntimeError):  # LLVM does not know what this processor has
        told.append(binding.get_host_cpu_features().flatten())
    told += [llvmlite.__version__, binding.get_process_triple(), binding.get_host_cpu_name()]
    return hashlib.sha256("\n".join(told).encode()).hexdigest()[:12]


def settings() -> list[str]:
    """Give what is set for Numba and makes a difference to machine code."""
    named = sorted((name, value) for name, value in os.environ.items() if name.startswith("NUMBA_"))
    return [f"{name}={value}" for name, value in named if name not in SILENT]


def needs_of(module: Any) -> tuple[str, ...]:
    """Name what the machine code of an LLVM module takes from elsewhere: what it declares and does not define.

    LLVM's own intrinsics are no names; what they may become (copies of memory, roots) each process has.
    """
    declared = (item.name for item in (*module.functions, *module.global_variables) if item.is_declaration)
    return tuple(sorted(name for name in declared if not name.startswith("llvm.")))


def read(file: Path) -> Code | None:
    """Read machine code: None where there is none, or not the whole of it, or where it needs what is not here."""
    try:
        told, _, rest = file.read_bytes().partition(b"\n")
        symbol, result, needs, sizes, check = json.loads(told)
    except (OSError, ValueError):
        return None
    ends = accumulate(sizes, initial=0)
    code = Code(symbol, result, tuple(rest[first:end] for first, end in pairwise(ends)), tuple(needs))
    return code if check == _check_of(code) and _provided(code.needs) else None


def _check_of(code: Code) -> int:
    return zlib.crc32(b"".join(code.images), zlib.crc32(json.dumps([code.symbol, code.result, code.needs]).encode()))


def _provided(needs: tuple[str, ...]) -> bool:
    """Tell whether the process provides what machine code needs: LLVM would end it where a name is unknown.

    Numba knows more names than LLVM, once it is imported and ready to compile: of its helper library, of Intel's
    vector mathematics, of functions that compilers on some platforms call.
    """
    from llvmlite import binding

    _engine()  # LLVM looks into the process itself from then on
    if all(map(binding.address_of_symbol, needs)):
        return True
    from numba.core.registry import cpu_target

    _ready = cpu_target.target_context.codegen()
    return all(map(binding.address_of_symbol, needs))


def write(file: Path, code: Code) -> None:
    """Write machine code, as a whole or not at all; where nothing can be written it is not."""
    told = json.dumps([code.symbol, code.result, code.needs, list(map(len, code.images)), _check_of(code)])
    part = file.with_name(f"{file.name}.{os.getpid()}-{threading.get_ident()}")
    with contextlib.suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        try:
            part.write_bytes(told.encode() + b"\n" + b"".join(code.images))
            part.replace(file)
        finally:
            part.unlink(missing_ok=True)


@contextlib.contextmanager
def alone(file: Path) -> Iterator[None]:
    """Wait until no other process makes this file; where files cannot be locked, two may do the same work.

    The lock goes when its process ends, however that is.
    """
    with contextlib.ExitStack() as held:
        with contextlib.suppress(OSError):
            file.parent.mkdir(parents=True, exist_ok=True)
            any(_locked(file.with_suffix(".lock"), held) for _ in range(MOST_WAITING))
        yield


def _locked(path: Path, held: contextlib.ExitStack) -> bool:
    """Lock a file that is made for it, and taken away afterwards; False if who had it before has taken it away."""
    if sys.platform == "win32":
        return True
    import fcntl

    lock = held.enter_context(path.open("wb"))
    fcntl.flock(lock, fcntl.LOCK_EX)
    if os.fstat(lock.fileno()).st_nlink == 0:
        return False
    held.callback(path.unlink, missing_ok=True)
    return True


def entry_of(symbol: str, kinds: tuple[Kind, ...]) -> tuple[str, bytes]:
    """Compile what calls a kernel with words that lie side by side in memory: the function's name, and its object file.

    It takes three addresses: where the result goes, where Numba would have an exception's, and the words.
    """
    from llvmlite import binding, ir

    byte, word = ir.IntType(8), ir.IntType(64)
    address = byte.as_pointer()
    floating = {"f": ir.FloatType(), "d": ir.DoubleType(), "P": address, "?": byte}
    formats = word_formats(kinds)
    types = [floating.get(letter) or ir.IntType(8 * struct.calcsize("=" + letter)) for letter in formats]
    taken = [ir.IntType(1) if letter == "?" else kind for letter, kind in zip(formats, types, strict=True)]
    module, name = ir.Module(), f"{symbol}.entry"
    kernel = ir.Function(module, ir.FunctionType(ir.IntType(32), [address, address, *taken]), symbol)
    entry = ir.Function(module, ir.FunctionType(ir.IntType(32), [address] * 3), name)
    builder = ir.IRBuilder(entry.append_basic_block())
    result, error, words = entry.args
    arguments = [result, error]
    for number, (kind, wanted) in enumerate(zip(types, taken, strict=True)):
        place = builder.gep(words, [word(WORD * number)])
        value = builder.load(builder.bitcast(place, kind.as_pointer()))
        arguments.append(value if kind is wanted else builder.trunc(value, wanted))
    builder.ret(builder.call(kernel, arguments))
    return name, _machine().emit_object(binding.parse_assembly(str(module)))


def loaded(code: Code, kinds: tuple[Kind, ...]) -> Callable[..., Any]:
    """Load machine code: what takes the words of arguments of these kinds, and gives back what the kernel returns."""
    engine = _engine()
    from llvmlite import binding

    for image in code.images:
        engine.add_object_file(binding.ObjectFileRef.from_data(image))
    engine.finalize_object()
    pointer, returned = ctypes.c_void_p, result_type(code.result)
    function = ctypes.CFUNCTYPE(ctypes.c_int32, pointer, pointer, pointer)(engine.get_function_address(code.symbol))
    by_reference, kind = ctypes.byref, code.result
    side_by_side = struct.Struct("=" + "".join(map(_padded, word_formats(kinds)))).pack

    def call(words: list[Any]) -> Any:
        room, error = returned(), pointer()
        status = function(by_reference(room), by_reference(error), side_by_side(*words))
        if status not in FINE:
            raise RuntimeError(f"a kernel ended with status {status}: {code.symbol}")
        return result_from(kind, room)

    return call


def _padded(letter: str) -> str:
    letter = "Q" if letter == "P" else letter
    return f"{letter}{WORD - struct.calcsize('=' + letter)}x"


@cache
def _machine() -> Any:
    """Tell LLVM what processor machine code is for."""
    from llvmlite import binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    return binding.Target.from_triple(binding.get_process_triple()).create_target_machine(jit=True)


def _engine() -> Any:
    """Give LLVM's home of machine code: for this process, for good.

    There is one, whichever threads ask for it first. ``functools.cache`` would make one for each of them and keep the
    last: with the others the code that was loaded into them would go, while it is called.
    """
    from llvmlite import binding

    with _making:
        if not _engines:
            _engines.append(binding.create_mcjit_compiler(binding.parse_assembly(""), _machine()))
        return _engines[0]


_making, _engines = threading.Lock(), list[Any]()
