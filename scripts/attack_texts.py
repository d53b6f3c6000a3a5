"""Hostile texts: what a user, a file or a file system may say, for names, keys, values and paths.

Lists to look at, and `texts`, which mixes their parts at random from a seed. Nothing is run here.
"""

from __future__ import annotations

import random
from collections.abc import Iterator

ESC, CSI, BEL = "\x1b", "\x9b", "\x07"

#: what a terminal would obey
ESCAPES = (
    f"{ESC}[31mred{ESC}[0m",
    f"{ESC}[2J{ESC}[H",  # clears the screen
    f"{ESC}]0;title{BEL}",
    f"{ESC}]52;c;cm0gLXJmIH4={BEL}",  # writes to the clipboard
    f"{ESC}]8;;http://example.org{ESC}\\link{ESC}]8;;{ESC}\\",
    f"{CSI}31m",
    "safe\rribbonopt: converged",
    "abc\b\b\bxyz",
    "line\nribbonopt: another",
    "line\u2028another\u2029third\x85fourth\x0bfifth\x0csixth",
    "\x00",
    "\x7f",
    "\u202egpj.exe",
    "\u2066isolated\u2069",
    "\u200fright\u061c",
    "\ufeffmark",
    "\udcff\udc80",  # undecodable bytes of a file name
    "\ud800",
    "soft\u00adhyphen",
)
#: what matplotlib, a browser, a formatter or a shell would read
MARKUP = (
    r"$\frac{$",
    "$",
    "$$",
    r"\$",
    r"$\alpha$",
    r"a_b^c{d}",
    r"\input{/etc/passwd}",
    "_hidden",
    "__proto__",
    "<script>alert(1)</script>",
    "</script><script>alert(1)</script>",
    "<!--<script>",
    "-->]]>",
    "<img src=x onerror=alert(1)>",
    "&amp;&#0;&lt;",
    "\"onmouseover='alert(1)'",
    "@data@ @script@",
    "%s %d %(name)s {name} {0} {",
    "$(id) `id` ; rm -rf ~",
    "${HOME}",
    "*?[a",
)
#: what a spreadsheet would run
FORMULAS = (
    "=1+1",
    '=HYPERLINK("http://example.org")',
    "=cmd|' /C calc'!A0",
    "+1+1",
    "-1+1",
    "-2+3+cmd|' /C calc'!A0",
    "@SUM(1)",
    "\t=1+1",
    "\r=1+1",
    "\n=1+1",
    "  =1+1",
    "\u00a0=1+1",
    "\ufeff=1+1",
    "\uff1d1+1",
    "\uff0b1",
    "\uff0d1+a",
    "\uff20SUM(1)",
    "﹦1+1",
    "⁼1+1",
    "'=1+1'",
    '"=1+1"',
    'a","=1+1',
    "a\n=1+1",
    "'",
    '"',
    "''",
)
#: what is no name of a folder on every system, leads elsewhere, or is a trap where it is typed
NAMES_REFUSED = (
    "",
    " ",
    ".",
    "..",
    "...",
    ". .",
    "../evil",
    "/tmp/evil",
    "a/b",
    "a\\b",
    "C:evil",
    "C:\\evil",
    "\\\\server\\share",
    "a:b",
    "a*",
    "a?",
    'a"',
    "a<b",
    "a>b",
    "a|b",
    "-rf",
    "--out",
    ".hidden",
    " before",
    "after ",
    "after.",
    "after\u3000",
    "CON",
    "con",
    "con.txt",
    "Nul",
    "aux.yaml",
    "COM1",
    "lpt9.x",
    "com¹",
    "CON .txt",
    "equilibria",
    "Solutions",
    "scene.yaml",
    "x" * 300,
    "日" * 100,
    "😀" * 60,
    *ESCAPES,
)
#: names in any language that must go through everything
NAMES_KEPT = (
    "moebius-half",
    "Möbius, halbes Band (3. Versuch)",
    "naïve élastique n° 2",
    "ε = 0.01 & λ² ~ 5%",
    "лента Мёбиуса",
    "メビウスの帯",
    "莫比乌斯 带",
    "뫼비우스의 띠",
    "שריט מוביוס",
    "شريط موبيوس",
    "نوار مو\u200cبیوس",
    "मोबियस पट्टी",
    "ribbon 😀",
    "👩\u200d🔬 lab",
    "a_b",
    "_a",
    "$x$",
    "$100 + {brace",
    "it's #1!",
    "a.b.c",
    "1e-3",
    "null",
    "~",
    "100%",
    "console",
    "com10x",
    "x" * 120,
    "日" * 40,
    "=1+1",
    "@home",
    "+",
    "%s {0} %(name)s",
    "$(id)",
    "`id`;",
    "&lt;b&gt;",
)
#: streams that cannot say everything
ENVIRONMENTS: tuple[dict[str, str], ...] = (
    {},
    {"PYTHONIOENCODING": "ascii"},
    {"PYTHONIOENCODING": "ascii:strict"},
    {"PYTHONIOENCODING": "cp1252"},
    {"PYTHONIOENCODING": "cp932"},
    {"PYTHONIOENCODING": "latin-1:strict"},
    {"PYTHONIOENCODING": "utf-16"},
    {"PYTHONIOENCODING": "utf-8:strict"},
    {"LC_ALL": "C"},
    {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
    {"LC_ALL": "POSIX", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
    {"PYTHONUTF8": "1"},
)
ALL = (*ESCAPES, *MARKUP, *FORMULAS, *NAMES_REFUSED, *NAMES_KEPT)


def texts(seed: int, count: int, longest: int = 200) -> Iterator[str]:
    """Yield texts of parts of the lists, of any characters, and sometimes far too long."""
    chance = random.Random(seed)
    for _ in range(count):
        kind = chance.random()
        if kind < 0.3:
            yield chance.choice(ALL)
        elif kind < 0.8:
            yield "".join(chance.choice(ALL) for _ in range(chance.randint(2, 5)))[:longest]
        elif kind < 0.98:
            yield "".join(map(_any, (chance.random() for _ in range(chance.randint(1, 30)))))
        else:
            yield chance.choice(ALL)[:20] * 100_000


def file_names(seed: int, count: int) -> Iterator[str]:
    """Yield texts that can be names of files on Linux, undecodable ones among them."""
    for text in texts(seed, count):
        name = text.replace("/", "").replace("\0", "")[:60]
        if name not in ("", ".", ".."):
            try:
                if len(name.encode("utf-8", "surrogateescape")) < 200:
                    yield name
            except UnicodeEncodeError:  # half a character that stands for no byte
                continue


def _any(share: float) -> str:
    """Return a character: of ASCII, of the first plane, or of any."""
    tops = (0x80, 0x800, 0x10000, 0x110000)
    top = tops[int(share * 4)]
    return chr(int(share * 4 % 1 * top))
