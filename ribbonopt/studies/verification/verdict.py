"""Whether a number that was computed is that of its source: within its bar and the source's digits.

    |ours - value| <= bar + half a unit of the source's last digit

to rounding of the source's number itself, which is kept as a double.
"""

from __future__ import annotations

import math
from typing import Any

from ribbonopt.classes import dataclass

from .claims import Claim
from .measured import COUNT, Measured

OK, OFF, FAILED = "ok", "off", "failed"
DIGITS = 16  # that a double tells apart


@dataclass(frozen=True, eq=False)
class Verdict:
    """A row, what was computed for it, and how that compares.

    Attributes
    ----------
    claim : Claim
        The row.
    found : Measured or None
        None where there is no answer: `message` says why.
    seconds : float
        CPU time that it took; of the first row of a scene, that of its solution or its branch.
    """

    claim: Claim
    found: Measured | None
    seconds: float
    message: str = ""

    @property
    def gap(self) -> float | None:
        """Difference to the source."""
        return None if self.found is None else abs(self.found.value - self.claim.value)

    @property
    def status(self) -> str:
        """OK, OFF or FAILED."""
        if self.found is None or self.gap is None:
            return FAILED
        rounding = math.ulp(self.claim.value) / 2
        return OK if self.gap <= self.found.bar + self.slack + rounding else OFF

    @property
    def slack(self) -> float:
        """Half a unit of the source's last digit."""
        digits = self.claim.digits
        return 0.0 if digits is None else 0.5 * 10.0 ** (1 - digits) * _unit(self.claim.value)

    @property
    def agreed(self) -> int | None:
        """Digits of the source that ours agree with, at most those it has; of zero decimals.

        None where there is no number, and for counts.
        """
        if self.found is None or self.gap is None or self.found.basis == COUNT:
            return None
        most = min(self.claim.digits or DIGITS, DIGITS)
        if self.gap <= self.slack:
            return most
        if not math.isfinite(self.gap):
            return 0
        relative = 2 * self.gap / _unit(self.claim.value)
        return max(0, min(most, 1 + math.floor(-math.log10(relative))))

    def plain(self) -> dict[str, Any]:
        """Return the row as plain data."""
        claim, found = self.claim, self.found
        return {
            "number": claim.number,
            "scene": claim.scene,
            "set": "; ".join(claim.given),
            "quantity": claim.quantity,
            "value": claim.value,
            "digits": "exact" if claim.digits is None else claim.digits,
            "ours": None if found is None else found.value,
            "bar": None if found is None else found.bar,
            "basis": None if found is None else found.basis,
            "gap": self.gap,
            "agreed": self.agreed,
            "seconds": self.seconds,
            "status": self.status,
            "message": self.message,
            "source": claim.source,
            "about": claim.about,
        }


def _unit(value: float) -> float:
    """Return the power of ten of a number's first digit; 1 of zero, whose digits are decimals."""
    return float(10.0 ** math.floor(math.log10(abs(value)))) if value else 1.0
