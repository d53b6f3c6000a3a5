"""A comparison or benchmark as aligned plain text; only the command line prints it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from .benchmark import Benchmark
from .compare import Comparison
from .findings import milliseconds
from .peers import PeerRow
from .rows import PairRow

HEAD = (
    *("pair", "mesh", "unknowns", "nonzeros", "iter"),
    *("build", "eval", "linear", "CPU ms", "quartiles"),
    *("n(0)", "m(0)", "u(s)", "H", "law", "frame", "status"),
)
UNITS = "errors of n(0), m(0), u(s) relative; drifts of H, law and directors along s"
LEFT = 2  # columns of words before those of numbers


def table(study: Comparison | Benchmark) -> str:
    """Return a study as text."""
    return _benchmark(study) if isinstance(study, Benchmark) else _comparison(study)


def _comparison(comparison: Comparison) -> str:
    """Return one line for each pair, its finest mesh; then failures and findings."""
    finest = _finest(comparison.rows)
    lines = [f"{comparison.name}: {comparison.timing.words}; {UNITS}"]
    lines += [f"truth: {comparison.truth}", ""]
    lines += aligned([HEAD, *(_cells(row) for row in finest if row.unknowns is not None)])
    reasons: dict[str, list[str]] = {}
    for row in finest:
        if not row.verified:
            reasons.setdefault(row.message, []).append(row.name)
    if reasons:
        lines += ["", "failed:"]
    lines += [f"  {'; '.join(names)}: {message}" for message, names in reasons.items()]
    return "\n".join([*lines, "", *comparison.sentences])


def _benchmark(benchmark: Benchmark) -> str:
    """Return measured orders and times at each error."""
    lines = [f"{benchmark.name}: {benchmark.timing.words}; interleaved"]
    lines += [f"truth: {benchmark.truth}", ""]
    orders: dict[str, list[str]] = {}
    for slope in benchmark.slopes:
        degree = f"{slope.degree}: " if slope.degree else ""
        orders.setdefault(slope.name, []).append(f"{degree}{slope.order:.1f}")
    cells = [(name, ", ".join(found)) for name, found in orders.items()]
    lines += aligned([("pair", "measured order by degree"), *cells], left=1)
    lines += ["", *benchmark.sentences]
    if benchmark.rivals:
        head = ("peer", "detail", "CPU ms", "quartiles", "error", "")
        lines += ["", *aligned([head, *map(_peer, benchmark.rivals)])]
    return "\n".join(lines)


def _peer(row: PeerRow) -> tuple[str, ...]:
    times = (_ms(row.solve), _quartiles(row))
    return (row.name, row.detail, *times, _short(row.error), row.message)


def aligned(rows: Sequence[Sequence[str]], left: int = LEFT) -> list[str]:
    """Return lines with equal columns, the first `left` of them and the last flush left."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = []
    for row in rows:
        last = len(row) - 1
        cells = [
            text.ljust(width) if i < left or i == last else text.rjust(width)
            for i, (text, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append("  ".join(cells).rstrip())
    return lines


def _finest(rows: Iterable[PairRow]) -> list[PairRow]:
    """Last row of each pair: that which met the tightest tolerance, or came closest to it."""
    last: dict[str, PairRow] = {}
    for row in rows:
        if row.verified or row.name not in last or not last[row.name].verified:
            last[row.name] = row
    return list(last.values())


def _cells(row: PairRow) -> tuple[str, ...]:
    counts = (row.unknowns, row.nonzeros, row.iterations)
    times = (row.build, row.evaluate, row.linear, row.solve)
    values = row.plain()
    names = ("error_n0", "error_m0", "error_u", "drift_invariant", "drift_law", "drift_frame")
    return (
        *(row.name, _mesh(row)),
        *("-" if count is None else str(count) for count in counts),
        *map(_ms, times),
        _quartiles(row),
        *(_short(values[name]) for name in names),
        row.status.replace("_", " "),
    )


def _mesh(row: PairRow) -> str:
    sizes: Mapping[str, int] = {"": row.degree, "x": row.intervals}
    text = "".join(f"{sign}{size}" for sign, size in sizes.items() if size)
    return f"{text}x{row.steps}" if row.steps > 1 else text


def _short(value: float | None) -> str:
    return "-" if value is None else f"{value:.0e}"


def _ms(seconds: float | None) -> str:
    return "-" if seconds is None else milliseconds(seconds)


def _quartiles(row: PairRow | PeerRow) -> str:
    return "-" if row.low is None or row.high is None else f"{_ms(row.low)}-{_ms(row.high)}"
