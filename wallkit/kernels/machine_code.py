"""Machine code on the disk: written once a kernel was compiled, loaded by LLVM and called by its address."""

from __future__ import annotations

import contextlib
import ctypes
import hashlib
import os
import struct
import sys
import threading
import zlib
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from wallkit.kernels.signatures import Kind, result_from, result_type, word_formats

WORD = 8
"""Bytes of a word."""
MOST_WAITING = 100
"""Processes that may go before one that waits for a lock: beyond, or where links are not counted, it does not wait."""
SETTINGS = ("WALLKIT_CPU_FEATURES", "WALLKIT_CPU_NAME")
"""What may be set for another processor than this one, as LLVM names it."""


class Code(NamedTuple):
    """Machine code of a kernel for arguments of some kinds.

    Attributes:
        symbol: name of the function that takes two addresses: where the result goes, and where the words are.
        result: kind of what it returns: None, a number's name, or a list of such.
        image: the object file, as bytes.
        needs: names of functions and variables that the process must provide, see :func:`needs_of`.
    """

    symbol: str
    result: Any
    image: bytes
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
    """Name what machine code is made for here: a digest of the processor, and of what may have been set."""
    import llvmlite
    from llvmlite import binding

    told = settings()
    with contextlib.suppress(RuntimeError):  # LLVM does not know what this processor has
        told.append(binding.get_host_cpu_features().flatten())
    told += [llvmlite.__version__, binding.get_process_triple(), binding.get_host_cpu_name()]
    return hashlib.sha256("\n".join(told).encode()).hexdigest()[:12]


def settings() -> list[str]:
    """Give what is set of SETTINGS."""
    return [f"{name}={os.environ[name]}" for name in SETTINGS if name in os.environ]


def needs_of(module: Any) -> tuple[str, ...]:
    """Name what the machine code of an LLVM module takes from elsewhere: what it declares and does not define.

    LLVM's own intrinsics are no names; what they may become (copies of memory, roots) each process has.
    """
    declared = (item.name for item in (*module.functions, *module.global_variables) if item.is_declaration)
    return tuple(sorted(name for name in declared if not name.startswith("llvm.")))


def read(file: Path) -> Code | None:
    """Read machine code: None where there is none, or not the whole of it, or where it needs what is not here."""
    import json  # late: small runs need no machine code

    try:
        told, _, image = file.read_bytes().partition(b"\n")
        symbol, result, needs, check = json.loads(told)
    except (OSError, ValueError):
        return None
    code = Code(symbol, result, image, tuple(needs))
    return code if check == _check_of(code) and _provided(code.needs) else None


def _check_of(code: Code) -> int:
    import json

    return zlib.crc32(code.image, zlib.crc32(json.dumps([code.symbol, code.result, code.needs]).encode()))


def _provided(needs: tuple[str, ...]) -> bool:
    """Tell whether the process provides what machine code needs: LLVM would end it where a name is unknown."""
    from llvmlite import binding

    _engine()  # LLVM looks into the process itself from then on
    return all(map(binding.address_of_symbol, needs))


def write(file: Path, code: Code) -> None:
    """Write machine code, as a whole or not at all; where nothing can be written it is not."""
    import json

    told = json.dumps([code.symbol, code.result, code.needs, _check_of(code)])
    part = file.with_name(f"{file.name}.{os.getpid()}-{threading.get_ident()}")
    with contextlib.suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        try:
            part.write_bytes(told.encode() + b"\n" + code.image)
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


def loaded(code: Code, kinds: tuple[Kind, ...]) -> Callable[..., Any]:
    """Load machine code: what takes the words of arguments of these kinds, and gives back what the kernel returns."""
    engine = _engine()
    from llvmlite import binding

    engine.add_object_file(binding.ObjectFileRef.from_data(code.image))
    engine.finalize_object()
    pointer, returned = ctypes.c_void_p, result_type(code.result)
    function = ctypes.CFUNCTYPE(None, pointer, pointer)(engine.get_function_address(code.symbol))
    by_reference, kind = ctypes.byref, code.result
    side_by_side = struct.Struct("=" + "".join(map(_padded, word_formats(kinds)))).pack

    def call(words: list[Any]) -> Any:
        room = returned()
        function(by_reference(room), side_by_side(*words))
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
