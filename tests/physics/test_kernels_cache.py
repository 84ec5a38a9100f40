"""Machine code on disk: a folder a version, and those of older versions go."""

import os

from wallkit.kernels import jit


def test_older_versions_are_cleared_but_for_those_used_last(tmp_path, monkeypatch):
    monkeypatch.setenv("WALLKIT_CACHE_DIR", str(tmp_path))
    for age in range(8):
        folder = tmp_path / f"kernels-{age:016}"
        (folder / "module").mkdir(parents=True)
        (folder / "module" / "fly.nbc").write_bytes(b"machine code")
        os.utime(folder, (1e9 - age, 1e9 - age))
    (tmp_path / "somebody-else").mkdir()
    own = jit.cache_folder()
    kept = {path.name for path in tmp_path.iterdir()}
    assert kept == {own.name, "somebody-else", *(f"kernels-{age:016}" for age in range(jit.KEPT - 1))}


def test_a_folder_that_cannot_be_written_is_no_error(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("WALLKIT_CACHE_DIR", str(tmp_path / "file" / "folder"))
    assert jit.cache_folder().name.startswith("kernels-")
