"""Text that leaves us is seen and never acts: on terminals, as names, in drawings and tables."""

import csv
import io
from pathlib import Path

import pytest
from hostile import ALL, FORMULAS, MARKUP, NAMES_KEPT, NAMES_REFUSED, acting, texts

from ribbonopt.cli.export import FOLDER
from ribbonopt.output.declared import BATCH_PICTURES, BRANCH_PICTURES, MANIFEST, MAP_PICTURES
from ribbonopt.output.staging import OWN_FILES
from ribbonopt.scene.text.yamltext import read
from ribbonopt.studies.batch.cells import as_cell, of_cell
from ribbonopt.studies.comparison.files import files_of
from ribbonopt.studies.maps.jobs import FOLDERS
from ribbonopt.studies.stress.files import FILES as STRESSED
from ribbonopt.studies.verification.files import FILES as VERIFIED
from ribbonopt.text import (
    RESERVED_NAMES,
    cell,
    drawn,
    is_executed,
    is_word,
    marked_up,
    name_fault,
    one_line,
    printable,
    quoted,
    shortened,
)

MANY = [*ALL, *(text for text in texts(seed=5, count=1500) if len(text) < 10_000)]


def halved(text: str) -> bool:
    """Whether a text has half a character, which no file in UTF-8 holds."""
    return any(0xD800 <= ord(character) < 0xE000 for character in text)


def test_nothing_acts_on_a_terminal() -> None:
    for text in MANY:
        assert not acting(printable(text)), repr(text)
        assert printable(text).count("\n") == text.count("\n")
        assert not acting(one_line(text)) | ({"\n"} & set(one_line(text))), repr(text)


def test_what_can_be_read_stays_as_it_is() -> None:
    for name in NAMES_KEPT:
        assert one_line(name) == name
    assert printable("two\nlines, a\u00a0space") == "two\nlines, a\u00a0space"


def test_what_is_hidden_is_told() -> None:
    assert printable("\x1b[31m\x9b\x07\u202e\udcff\t\r") == r"\x1b[31m\x9b\x07\u202e\udcff\t\r"
    assert one_line("a\nb") == r"a\nb"


def test_long_texts_keep_both_ends() -> None:
    assert shortened("x" * 80, 80) == "x" * 80
    found = shortened("a" * 3_000_000 + "b" * 3_000_000, 80)
    assert len(found) < 130
    assert found.startswith("a" * 60 + " ... (5,999,920 more")
    assert found.endswith("b" * 20)


@pytest.mark.parametrize("name", NAMES_REFUSED, ids=ascii)
def test_names_that_are_no_folders_are_refused(name: str) -> None:
    assert name_fault(name)


@pytest.mark.parametrize("name", NAMES_KEPT, ids=ascii)
def test_names_in_any_language_are_kept(name: str, tmp_path: Path) -> None:
    assert name_fault(name) == ""
    # With the longest that is added to a name, it is a folder, and the one that was meant.
    folder = tmp_path / f".{name}-branch.not-the-problem-asked-for.kept.new"
    folder.mkdir()
    assert folder.parent == tmp_path
    assert [path.name for path in tmp_path.iterdir()] == [folder.name]


def test_names_of_accepted_texts_lead_nowhere_else(tmp_path: Path) -> None:
    accepted = [text for text in MANY if not name_fault(text)]
    assert len(accepted) > 100
    for name in accepted:
        place = (tmp_path / name).resolve()
        assert (place.parent, place.name) == (tmp_path.resolve(), name)


def test_what_our_folders_hold_is_reserved() -> None:
    ours = {*OWN_FILES, MANIFEST, *BATCH_PICTURES, *BRANCH_PICTURES, "solutions"}
    ours |= {"rows.jsonl", "table.csv", "study.json", "branch.jsonl", "branch.csv"}
    ours |= {*files_of("comparison"), *files_of("benchmark"), "special.csv"}
    ours |= {FOLDER, "laws.csv", "laws.json", "laws.png", *VERIFIED, *STRESSED}
    ours |= {*MAP_PICTURES, *FOLDERS, "map.json", "map.csv", "jobs.jsonl"}
    assert ours == RESERVED_NAMES
    assert all(name_fault(name.upper()) for name in ours)


def test_words_of_formulas() -> None:
    assert all(map(is_word, ("a", "u2_end", "_", "a" * 100)))
    assert not any(map(is_word, ("a" * 101, "1a", "", "a b", "ä", "=a", "a\n", "a.b")))


def test_drawn_texts_are_never_mathematics() -> None:
    from matplotlib.cbook import is_math_text

    for text in MANY:
        found = drawn(text)
        assert not is_math_text(found), repr(text)
        assert not found.startswith("_")  # legends leave such labels out
        assert len(found.replace(r"\$", "$")) <= 40 * len(r"\U00012345")
        assert "\n" not in found
    assert drawn("$a_b$") == r"\$a_b\$"
    assert drawn("x" * 41) == "x" * 39 + "…"


def test_marked_up_texts_are_no_elements() -> None:
    for text in (*MARKUP, *MANY):
        assert not set("<>\"'") & set(marked_up(text))
    assert marked_up("<b>&\x1b") == r"&lt;b&gt;&amp;\x1b"


#: by their numbers in Unicode: what spreadsheets may begin a formula by
SIGNS = "=+-@\uff1d\uff0b\uff0d\uff20\ufe62\ufe63\ufe66\ufe6b\u207a\u207c\t\r\n"


def test_no_cell_begins_like_a_formula() -> None:
    for text in (*FORMULAS, *MANY):
        first = cell(text).lstrip(" \u00a0\u3000")[:1]
        assert first not in tuple(SIGNS) or _number(text), repr(text)
        assert first != "\ufeff"
    for sign in SIGNS:
        assert is_executed(f"{sign}1+a")
    for text in ("-0.5", "+1e-3", "a=1", "1-2", "", "note: =1"):
        assert not is_executed(text)
        assert cell(text) == text


def _number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def test_texts_in_quotes_are_the_same_texts() -> None:
    for text in MANY:
        if not halved(text):
            assert read(quoted(text)).data == text, repr(text)


def test_inputs_come_back_from_their_cells() -> None:
    values = [text for text in MANY if not halved(text)]
    values += [1, 0.1, -2.5e-8, True, False, None, [1, "a", None], {"type": "x", "a": [-1, "=b"]}]
    values += ["1", "true", "null", "", " ", "0x10", "{a: 1}", "[", "# a", "- a", "a: b", "~"]
    file = io.StringIO(newline="")
    csv.writer(file).writerows([told(as_cell(value))] for value in values)
    file.seek(0)
    for value, row in zip(values, csv.reader(file), strict=True):
        (text,) = row or [""]
        assert of_cell(text, "table.csv") == value, repr(value)
        assert type(of_cell(text, "table.csv")) is type(value)


def told(value: object) -> object:
    return cell(value) if isinstance(value, str) else value
