"""Files of all kinds spoiled at random, seeded: each is read, or refused in one message."""

import sys
from collections import Counter
from itertools import islice
from pathlib import Path

import pytest

from ribbonopt import reading

sys.path.append(str(Path(__file__).resolve().parents[3] / "scripts"))

from attack_files import FILES, Originals, mutations, outcome

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no pipes with names")


@pytest.fixture(scope="module")
def originals(tmp_path_factory: pytest.TempPathFactory) -> Originals:
    return Originals(tmp_path_factory.mktemp("sound") / "sound")


@pytest.mark.parametrize("kind", FILES)
@pytest.mark.parametrize(
    ("seed", "count"),
    [
        (1, 40),
        pytest.param(2, 200, marks=pytest.mark.slow),
        pytest.param(2, 500, marks=pytest.mark.sweep),
    ],
)
@pytest.mark.filterwarnings("default")
def test_spoiled_files_are_read_or_refused(
    originals: Originals,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    kind: str,
    seed: int,
    count: int,
) -> None:
    monkeypatch.setattr(reading, "PATIENCE", 0.05)
    counts: Counter[str] = Counter()
    for mutation in islice(mutations(seed, originals, tmp_path, kinds=(kind,)), count):
        word, told = outcome(mutation, originals)
        assert word != "fault", f"{mutation.file}: {mutation.label}: {told}"
        counts[word] += 1
    assert counts["refused"] > count / 4
    assert counts["read"] > 0


def test_a_fault_is_seen(originals: Originals, tmp_path: Path) -> None:
    mutation = next(mutations(1, originals, tmp_path, kinds=("batch",)))
    originals.copy("batch", mutation.folder)
    assert outcome(mutation, originals) == ("read", "")
    word, told = outcome(mutation._replace(folder=mutation.folder / "no"), originals)
    assert (word, "no batch" in told) == ("refused", True)
    word, told = outcome(mutation._replace(kind="none of ours"), originals)
    assert (word, told.startswith("KeyError")) == ("fault", True)
