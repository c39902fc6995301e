"""How much one visitor may ask for, and how often a password may be tried. Pure: the time is handed in."""

from __future__ import annotations

import ipaddress
from dataclasses import dataclass

__all__ = ["Attempts", "Rate", "network_of"]

MAX_TRACKED = 10_000
"""Visitors that are told apart; when there are more, those that were quiet longest are forgotten."""


@dataclass(slots=True)
class _Bucket:
    tokens: float
    at_s: float


class Rate:
    """So many a second on average, and so many at once.

    Args:
        per_s: Average.
        burst: At once.
    """

    def __init__(self, per_s: float, burst: float) -> None:
        self._per_s, self._burst = per_s, burst
        self._buckets: dict[str, _Bucket] = {}

    def take(self, who: str, now_s: float) -> float:
        """Use one up.

        Returns:
            0 if it was granted, else the seconds to wait.
        """
        bucket = self._buckets.pop(who, None) or _Bucket(self._burst, now_s)
        bucket.tokens = min(self._burst, bucket.tokens + (now_s - bucket.at_s) * self._per_s)
        bucket.at_s = now_s
        self._buckets[who] = bucket  # at the end: those at the beginning were quiet longest
        if len(self._buckets) > MAX_TRACKED:
            del self._buckets[next(iter(self._buckets))]
        if bucket.tokens < 1:
            return (1 - bucket.tokens) / self._per_s
        bucket.tokens -= 1
        return 0.0


class Attempts:
    """Failed attempts to sign in: after a few, each further one doubles the wait.

    Strangers lock nobody else out: each address has its own count, and within it each account.

    Args:
        free: Failures without a wait.
        longest_s: The longest wait.
    """

    def __init__(self, free: int = 5, longest_s: float = 300.0) -> None:
        self._free, self._longest_s = free, longest_s
        self._failed: dict[tuple[str, str], tuple[int, float]] = {}

    def wait_s(self, address: str, account: str, now_s: float) -> float:
        """Seconds until somebody at `address` may try `account` again; 0: now."""
        here = network_of(address)
        return max(
            self._wait((here, account), self._free, now_s), self._wait((here, ""), 4 * self._free, now_s)
        )

    def failed(self, address: str, account: str, now_s: float) -> None:
        """An attempt failed."""
        here = network_of(address)
        for who in {(here, account), (here, "")}:
            count, last_s = self._failed.pop(who, (0, now_s))
            if now_s - last_s > self._longest_s:
                count = 0
            self._failed[who] = (count + 1, now_s)
        while len(self._failed) > MAX_TRACKED:
            del self._failed[next(iter(self._failed))]

    def succeeded(self, address: str, account: str) -> None:
        """They know the secret: their attempts were none."""
        here = network_of(address)
        own, _ = self._failed.pop((here, account), (0, 0.0))
        count, last_s = self._failed.pop((here, ""), (0, 0.0))
        if count > own:
            self._failed[here, ""] = (count - own, last_s)

    def _wait(self, who: tuple[str, str], free: int, now_s: float) -> float:
        count, last_s = self._failed.get(who, (0, now_s))
        if count < free:
            return 0.0
        pause_s = min(2.0 ** (count - free + 1), self._longest_s)
        return max(0.0, last_s + pause_s - now_s)


def network_of(address: str) -> str:
    """What one machine has for itself: of IPv6 the first half, the rest of which it chooses as it likes."""
    try:
        parsed = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    if parsed.version == 6 and parsed.ipv4_mapped is None:
        return str(ipaddress.ip_network((parsed, 64), strict=False))
    return str(parsed)
