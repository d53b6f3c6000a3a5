"""Lines are with the system at once, and on disk a second later."""

from pathlib import Path

import pytest

from ribbonopt.output import disk


def test_lines_are_on_disk_a_second_later(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    now, synced = [0.0], list[int]()
    path = tmp_path / "rows"
    monkeypatch.setattr(disk.time, "monotonic", lambda: now[0])
    monkeypatch.setattr(disk.os, "fsync", lambda _: synced.append(path.read_text().count("\n")))
    file = disk.Appended(open(path, "a", encoding="utf-8"))
    for second in (0.2, 0.9, 1.1, 1.2, 2.0, 2.2):
        now[0] = second
        file.write("row\n")
    assert path.read_text().count("\n") == 6
    assert synced == [3, 6]
    file.write("row\n")
    file.close()
    file.close()
    assert synced == [3, 6, 7]


def test_what_the_disk_does_not_take_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "file").write_text("text")
    disk.sync_all(tmp_path)
    monkeypatch.setattr(disk.os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        disk.sync_all(tmp_path)
