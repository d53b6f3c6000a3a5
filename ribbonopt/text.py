"""Text that leaves us: messages, names of folders, words in drawings, cells of tables.

What a file or a user says may hold anything: escapes of terminals, signs that turn the direction of
reading, TeX, formulas of spreadsheets, half characters. It is to be seen, and never to act.
"""

from __future__ import annotations

_SEEN = "\n\u200c\u200d"  # besides what is printable: breaks, and joiners, which shape letters
LONGEST_NAME = 120  # bytes in UTF-8: with what is added to it, a folder has room for 255
LONGEST_WORD = 100

_NOT_IN_NAMES = frozenset('/\\:*?"<>|')
_PORTS = (f"{port}{number}" for port in ("com", "lpt") for number in "0123456789¹²³")
#: what Windows takes for a device, whatever follows a dot
_DEVICES = frozenset(("con", "prn", "aux", "nul", "conin$", "conout$", *_PORTS))
#: figures of results, branches and batches, as .png, .svg or .pdf
_FIGURES = (
    *("strains", "plane", "ribbon", "modes", "branch", "ribbons"),
    *("outcomes", "scatter", "special"),
)
#: what our own folders hold: a folder of results so named would be taken for a part of a result
RESERVED_NAMES = frozenset(
    (
        "exports",
        *("equilibria", "solutions", "scene.yaml", "summary.json", "solution.npz", "exports.json"),
        *("strains.png", "plane.png", "ribbon.png", "branch.png", "ribbons.png", "report.html"),
        *(f"{name}.{f}" for name in _FIGURES for f in ("svg", "pdf")),
        *("modes.json", "modes.csv", "modes.npz", "modes.png"),
        *("branch.gif", "branch.mp4"),
        *("outcomes.png", "scatter.png", "rows.jsonl", "table.csv", "study.json", "branch.jsonl"),
        *("branch.csv", "comparison.csv", "comparison.json", "comparison.png"),
        *("benchmark.csv", "benchmark.json", "benchmark.png"),
        *("laws.csv", "laws.json", "laws.png", "special.csv", "special.png"),
        *("verification.csv", "verification.json", "verification.md"),
        *("stress.csv", "stress.json", "stress.png", "view.html"),
        *("map.json", "map.csv", "map.png", "map.svg", "map.pdf", "jobs.jsonl"),
        *("map-branches", "map-loci", "map-points"),
    )
)
_EXECUTED = frozenset("=+-@")


def printable(text: str) -> str:
    """Return text as it is seen: control characters and the like as escapes; line breaks stay."""
    if text.isprintable():
        return text
    return text.translate({ord(character): _visible(character) for character in set(text)})


def one_line(text: str) -> str:
    """Return text as it is seen, line breaks as escapes too."""
    return printable(text).replace("\n", r"\n")


def shortened(text: str, most: int) -> str:
    """Return text of about `most` characters at most: of longer ones both ends, and what lacks."""
    if len(text) <= most:
        return text
    head, tail = most - most // 4, most // 4
    return f"{text[:head]} ... ({len(text) - head - tail:,} more characters) ... {text[-tail:]}"


def _visible(character: str) -> str:
    if character.isprintable() or character in _SEEN:
        return character
    import unicodedata  # few texts need it

    if unicodedata.category(character) == "Zs":  # spaces of all widths
        return character
    return character.encode("unicode_escape").decode()


def name_fault(name: str) -> str:
    """Return what is wrong with a name of a scene or a study; "" if nothing.

    A folder of results has the name of what it is the result of: it must be one on every system,
    lead nowhere else, and be no trap where it is typed.
    """
    says = "it names the folder of results too"
    # Half a character, which UTF-8 cannot say, is refused below.
    size = len(name.encode(errors="surrogatepass"))
    if size > LONGEST_NAME:
        return (
            f"is {size:,} bytes long, expected at most {LONGEST_NAME} (a letter is one, of many "
            f"scripts two to four); {says}"
        )
    if not name.strip(". "):
        return f"expected a name with letters or digits; {says}"
    if one_line(name) != name:
        return f"expected a name without control characters; {says}"
    if found := next((sign for sign in name if sign in _NOT_IN_NAMES), ""):
        return f'expected a name without {found}; {says} (leave out / \\ : * ? " < > |)'
    if name != name.strip() or name[0] in ".-" or name.endswith("."):
        return f"expected a name without a space or . at its ends, or - before it; {says}"
    if name.split(".")[0].strip().lower() in _DEVICES or name.casefold() in RESERVED_NAMES:
        return f"is reserved for something else; choose another name, {says}"
    return ""


def is_word(name: str) -> bool:
    """Whether a name can stand in formulas and over columns: of ASCII letters, digits and _."""
    return name.isascii() and name.isidentifier() and len(name) <= LONGEST_WORD


def drawn(text: str, most: int = 40) -> str:
    """Return text that matplotlib draws as it is, on one line, cut where a figure has no room."""
    text = one_line(text if len(text) <= most else f"{text[: most - 1]}…")
    # What begins with _ is no label: legends leave it out, and warn of it.
    return (" " if text.startswith("_") else "") + text.replace("$", r"\$")


def marked_up(text: str) -> str:
    """Return text as HTML, for any place of a page but scripts."""
    from html import escape  # only pages need it

    return escape(printable(text))


def cell(text: str) -> str:
    """Return what a table of CSV says for a text, which no spreadsheet takes for a formula.

    A text that one would run is written in quotes, as YAML: read as that it is the same text.
    """
    return quoted(text) if is_executed(text) else printable(text)


def is_executed(text: str) -> bool:
    """Whether a spreadsheet may take a text for a formula; numbers are none."""
    first = next((c for c in text if c.isprintable() and not c.isspace()), "")
    if not first.isascii():
        import unicodedata  # few texts need it

        first = unicodedata.normalize("NFKC", first)[:1]  # signs of full width, raised, small
    return (first in _EXECUTED and not _is_number(text)) or text[:1] in ("\t", "\r", "\n")


def quoted(text: str) -> str:
    """Return a text as YAML in quotes, on one line."""
    if text.isprintable():
        return "'" + text.replace("'", "''") + "'"
    inner = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c.isprintable() else _escaped(c) for c in inner) + '"'


def _escaped(character: str) -> str:
    """Return an escape that YAML knows."""
    code = ord(character)
    return f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return text.isascii()
