"""The bounded decompressor: exact on whole streams, honest on broken ones, stopped by name on bombs."""

import gzip
import zlib

import pytest
import zstandard
from hypothesis import given
from hypothesis import strategies as st

from importers.errors import LimitError
from importers.limits import MAX_INPUT_BYTES, Unpacker, check_input_size, good_coordinate

PACK = {"zlib": zlib.compress, "gzip": gzip.compress, "zstd": zstandard.ZstdCompressor().compress}
EDGE = 1 << 18  # the size of the pieces inside


@pytest.mark.parametrize("packing", PACK)
@pytest.mark.parametrize("size", [0, 1, EDGE - 1, EDGE, EDGE + 1, 3 * EDGE])
def test_a_whole_stream_comes_back_whole(packing, size):
    for raw in (bytes(size), bytes(i * i % 251 for i in range(size))):
        assert Unpacker().unpack(PACK[packing](raw), packing) == (raw, "")


@given(st.binary(max_size=2000), st.binary(max_size=50))
def test_what_follows_a_stream_is_ignored(raw, rest):
    for packing, pack in PACK.items():
        packed = pack(raw)
        if not (packing == "gzip" and rest.startswith(b"\x1f\x8b")) and rest[:1] != b"\x28":
            assert Unpacker().unpack(packed + rest, packing) == (raw, "")


@pytest.mark.parametrize("packing", ["gzip", "zstd"])
def test_members_one_after_the_other_are_one_stream(packing):
    pack = PACK[packing]
    assert Unpacker().unpack(pack(b"one") + pack(b"") + pack(b"two"), packing) == (b"onetwo", "")


@pytest.mark.parametrize("packing", PACK)
@pytest.mark.parametrize("cut", [1, 5, EDGE])
def test_a_truncated_stream_gives_what_stands_before_the_cut(packing, cut):
    raw = bytes(i * i * 7 % 251 ^ (i >> 9) & 255 for i in range(4 * EDGE))
    packed = PACK[packing](raw)
    data, damage = Unpacker().unpack(packed[: max(len(packed) - cut, len(packed) // 2)], packing)
    assert raw.startswith(data)
    assert damage


@pytest.mark.parametrize("packing", PACK)
def test_what_is_no_stream_gives_nothing_and_says_so(packing):
    for packed in (b"", b"abc"):
        data, damage = Unpacker().unpack(packed, packing)
        assert data == b""
        assert damage


@pytest.mark.parametrize("packing", PACK)
def test_one_stream_may_not_grow_past_75_megabytes(packing):
    with pytest.raises(LimitError, match="one compressed stream, at most 75 MB"):
        Unpacker("bomb").unpack(PACK[packing](bytes(75_000_001)), packing)
    assert len(Unpacker().unpack(PACK[packing](bytes(75_000_000)), packing).data) == 75_000_000


def test_all_streams_together_may_not_grow_past_256_megabytes():
    packed = zlib.compress(bytes(70_000_000))
    unpacker = Unpacker()
    for _ in range(3):
        unpacker.unpack(packed, "zlib")
    with pytest.raises(LimitError, match="all compressed streams, at most 256 MB"):
        unpacker.unpack(packed, "zlib")


def test_the_input_may_be_64_mebibytes():
    check_input_size(MAX_INPUT_BYTES)
    with pytest.raises(LimitError, match="size of the input, at most 64 MiB"):
        check_input_size(MAX_INPUT_BYTES + 1, "huge.ai")


def test_a_coordinate_is_finite_and_below_a_thousand_million():
    assert good_coordinate(-1e9)
    assert not any(map(good_coordinate, (1.0000001e9, float("inf"), float("nan"))))


def test_a_zstd_window_of_a_gigabyte_is_refused():
    parameters = zstandard.ZstdCompressionParameters(window_log=30)
    packer = zstandard.ZstdCompressor(compression_params=parameters).compressobj()
    packed = packer.compress(b"x" * 100) + packer.flush()
    data, damage = Unpacker().unpack(packed, "zstd")
    assert (data, "memory" in damage) == (b"", True)
