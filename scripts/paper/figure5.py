"""Figure 5: the Moebius ribbon of the regularised law (6.1), and that of Wunderlich's (6.3)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ribbonopt import Solution

from .figure4 import MOMENTS
from .found import MIDDLE, Answers, Found, Rows, half_of, where
from .numbers import Number
from .page import BENDING, FAINT, GREEN, INK, ORANGE, TWIST, Panel
from .parts import label_strains, shade_plane
from .relations import Array, on_arrays, regularized
from .space import Space

TITLE = r"Figure 5   Regularised law, $\varepsilon = 0.01$, and Wunderlich's, $w/L = 0.2/\pi$"
EPSILON = 0.01
DASHED = (0, (4, 2))
RED = "#b91c1c"


def panels(found: Found) -> list[Panel]:
    """Return the four panels."""
    rows = half_of(found.regularized)
    wide = half_of(found.wunderlich)
    plane = r"in the plane $(u_2, u_3)$"
    space = r"in $(m_2, m_3, u_2)$, with the surface (6.1)"
    limit = r"$u_2(0)$ as $\varepsilon \to 0$"
    return [
        Panel("a", "strains along the ribbon", _strains(rows, wide), _of_strains(found)),
        Panel("b", plane, _plane(found, rows, wide), _of_plane(found)),
        Panel("c", space, _space(rows, wide), _of_space(found), solid=True),
        Panel("d", limit, _limit(found), _of_limit(found)),
    ]


def columns(found: Found) -> dict[str, Any]:
    """Return the curves as columns, those of Wunderlich's law behind."""
    named = half_of(found.regularized)._asdict()
    wide = half_of(found.wunderlich)._asdict()
    return named | {f"wunderlich_{name}": wide[name] for name in wide if name != "s"}


def entry(solution: Solution) -> float:
    """Return where |eta| passes 1 before the middle, the point W+; W- lies as far behind it."""

    def inside(s: float) -> float:
        u2, u3 = (abs(float(solution.sample(s, name))) for name in ("u2", "u3"))
        return u2 - u3

    return where(inside, 0.4, MIDDLE - 1e-6)


def border() -> float:
    """Return m2 / |m3| where |eta| = 1 under (6.1)."""

    def beyond(ratio: float) -> float:
        u2, u3 = on_arrays(regularized(EPSILON).strains, ratio, 1.0)
        return float(u2 - u3)

    return where(beyond, 1e-6, 1.0)


def order(branch: list[dict[str, Any]], limit: float) -> float:
    """Return the order in epsilon in which u2(0) goes to its limit."""
    values, u2 = _branch(branch)
    used = values <= 1e-3
    return float(np.polyfit(np.log(values[used]), np.log(np.abs(u2[used] - limit)), 1)[0])


def _branch(branch: list[dict[str, Any]]) -> tuple[Array, Array]:
    values, u2 = (np.array([row[name] for row in branch]) for name in ("law.epsilon", "u2"))
    return values, u2


def _whole(rows: Rows) -> Rows:
    return Rows(*(np.concatenate(pair) for pair in zip(rows, rows.mirrored(), strict=True)))


def _strains(rows: Rows, wide: Rows) -> Callable[[Any], None]:
    def draw(axes: Any) -> None:
        for name, colour in (("u2", BENDING), ("u3", TWIST)):
            whole = _whole(rows)
            label = f"$u_{name[1]}$, regularised"
            axes.plot(whole.s, getattr(whole, name), color=colour, lw=1.8, label=label)
        whole = _whole(wide)
        for name in ("u2", "u3"):
            axes.plot(whole.s, getattr(whole, name), color="black", lw=1.2, ls=DASHED)
        axes.plot([], [], color="black", lw=1.2, ls=DASHED, label="Wunderlich")
        label_strains(axes)

    return draw


def _plane(found: Found, rows: Rows, wide: Rows) -> Callable[[Any], None]:
    def draw(axes: Any) -> None:
        shade_plane(axes)
        whole = _whole(rows)
        axes.plot(whole.u2, whole.u3, color=BENDING, lw=1.9, label="regularised")
        whole = _whole(wide)
        axes.plot(whole.u2, whole.u3, color="black", lw=1.2, ls=DASHED, label="Wunderlich")
        s = entry(found.regularized)
        u2, u3 = (float(found.regularized.sample(s, name)) for name in ("u2", "u3"))
        for sign, name in ((1, "$W^+$"), (-1, "$W^-$")):
            axes.plot(sign * u2, u3, "o", color=BENDING, ms=5, zorder=4)
            axes.annotate(
                name,
                (sign * u2, u3),
                (-sign * 3, 6),
                textcoords="offset points",
                ha="right" if sign > 0 else "left",
                fontsize=9.5,
                color=INK,
            )
        axes.legend(frameon=False, fontsize=8.5, loc="lower left")

    return draw


def _space(rows: Rows, wide: Rows) -> Callable[[Any], None]:
    def draw(axes: Any) -> None:
        space = Space(MOMENTS, 24, -128)
        law, ratio = regularized(EPSILON), border()
        m3 = np.unique(np.concatenate([np.linspace(*MOMENTS[1], 37), [0.0]]))
        for low, high, colour in (
            (ratio, None, GREEN),
            (-ratio, ratio, ORANGE),
            (None, -ratio, GREEN),
        ):
            ends = [
                sign * MOMENTS[0, 1] + 0 * m3 if end is None else end * np.abs(m3)
                for end, sign in ((low, -1), (high, 1))
            ]
            share = np.linspace(0, 1, 25)[:, None]
            m2 = (1 - share) * ends[0] + share * ends[1]
            u2 = on_arrays(law.strains, m2, np.broadcast_to(m3, m2.shape))[0]
            space.surface(m2, np.broadcast_to(m3, m2.shape), u2, colour, mesh=6)
        whole = _whole(rows)
        space.curve(whole.m2, whole.m3, whole.u2, BENDING, 2)
        whole = _whole(wide)
        space.curve(whole.m2, whole.m3, whole.u2, "black", 1.3, (0.024, 0.016), lift=0.1)
        space.paint(axes, ("$m_2$", "$m_3$", "$u_2$"))
        words = "blue: regularised\ndashed: Wunderlich"
        axes.text2D(0.05, 0.98, words, transform=axes.transAxes, fontsize=8.5, va="top")

    return draw


def _limit(found: Found) -> Callable[[Any], None]:
    def draw(axes: Any) -> None:
        values, u2 = _branch(found.branch)
        limit = float(found.sadowsky.u0[1])
        label = "regularised (6.1)"
        axes.semilogx(values, u2, "o-", color=BENDING, lw=1.6, ms=4, label=label)
        axes.axhline(limit, color=RED, lw=1.2, label="Sadowsky")
        wide = float(found.wunderlich.u0[1])
        axes.axhline(wide, color="black", lw=1.1, ls=DASHED, label="Wunderlich")
        axes.set(xlabel=r"$\varepsilon$", ylabel="$u_2(0)$  ($1/L$)", ylim=(3.2, 3.41))
        axes.legend(frameon=False, fontsize=8.5, loc=(0.1, 0.66))
        inner = axes.inset_axes((0.14, 0.14, 0.44, 0.42))
        inner.loglog(values, limit - u2, "o-", color=BENDING, lw=1.2, ms=2.5)
        inner.set_title("distance from Sadowsky's", fontsize=8, color=INK)
        inner.tick_params(labelsize=7, colors=INK)
        inner.set_xlabel(r"$\varepsilon$", fontsize=8, labelpad=0)
        inner.grid(True, color=FAINT, alpha=0.25, lw=0.5)

    return draw


def _of_strains(found: Found) -> list[Number]:
    regular, wide = Answers(found.regularized), Answers(found.wunderlich)
    u3 = [float(ribbon.sample(MIDDLE, "u3")) for ribbon in (found.regularized, found.wunderlich)]
    return [
        regular.number("$u_2(0)$", "u2"),
        regular.number("$u_3(0)$", "u3"),
        Number("$u_3(1/2)$", u3[0]),
        wide.number("Wunderlich: $u_2(0)$", "u2"),
        Number("Wunderlich: $u_3(1/2)$", u3[1], "0"),
    ]


def _of_plane(found: Found) -> list[Number]:
    s, wide = entry(found.regularized), half_of(found.wunderlich)
    gap = np.abs(half_of(found.regularized).u2 - wide.u2)[wide.s <= 0.4].max()
    return [
        Number("$W^+$ at $s$", s),
        Number("$W^-$ at $s$", 1 - s),
        Number(r"$u_2 = u_3$ at $W^+$", float(found.regularized.sample(s, "u3"))),
        Number(r"Wunderlich: largest $|\eta|$", float(np.abs(wide.u3 / wide.u2).max())),
        Number(r"largest difference of $u_2$, $s \leq 0.4$", float(gap)),
    ]


def _of_space(found: Found) -> list[Number]:
    regular, wide = Answers(found.regularized), Answers(found.wunderlich)
    printed = {"n0y": "43.1", "n0z": "43.0", "m0y": "2.15", "m0z": "-8.65"}
    names = {key: f"${key[0]}_{key[2]}(0)$" for key in printed}
    return [
        *(regular.number(names[key], key, digits) for key, digits in printed.items()),
        regular.number("$H(0)$, no invariant", "H0"),
        Number("$H(1/2)$", float(found.regularized.sample(MIDDLE, "H"))),
        *(wide.number(f"Wunderlich: {name}", key) for key, name in names.items()),
    ]


def _of_limit(found: Found) -> list[Number]:
    limit, wide = Answers(found.sadowsky), Answers(found.wunderlich)
    rows = [limit.number("limit, Sadowsky", "u2", "3.3866")]
    for power in (-2, -3, -7):
        row = next(r for r in found.branch if np.isclose(r["law.epsilon"], 10.0**power))
        bar = row["error"] * abs(row["u2"])
        rows.append(Number(rf"at $\varepsilon = 10^{{{power}}}$", row["u2"], "", bar))
    return [
        *rows,
        Number(r"order in $\varepsilon$", order(found.branch, limit.value("u2"))),
        wide.number("Wunderlich: $H$", "H0"),
        wide.number("Wunderlich: energy of the whole", "whole"),
    ]
