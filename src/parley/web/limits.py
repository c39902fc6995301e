"""How much one visitor may ask for, and how often a password may be tried. Pure: the time is handed in."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Attempts", "Rate"]

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

    Args:
        free: Failures without a wait, per address.
        free_in_all: The same for all addresses together.
        longest_s: The longest wait.
    """

    def __init__(self, free: int = 5, free_in_all: int = 50, longest_s: float = 300.0) -> None:
        self._free, self._free_in_all, self._longest_s = free, free_in_all, longest_s
        self._failed: dict[str, tuple[int, float]] = {}

    def wait_s(self, address: str, now_s: float) -> float:
        """Seconds until `address` may try again; 0: now."""
        return max(self._wait(address, self._free, now_s), self._wait("", self._free_in_all, now_s))

    def failed(self, address: str, now_s: float) -> None:
        """An attempt failed; both the address and everybody together are counted."""
        for who in (address, ""):
            count, last_s = self._failed.pop(who, (0, now_s))
            if now_s - last_s > self._longest_s:
                count = 0
            self._failed[who] = (count + 1, now_s)
        if len(self._failed) > MAX_TRACKED:
            del self._failed[next(who for who in self._failed if who)]

    def succeeded(self, address: str) -> None:
        """The address knows the secret: its attempts were none."""
        own, _ = self._failed.pop(address, (0, 0.0))
        count, last_s = self._failed.get("", (0, 0.0))
        self._failed[""] = (max(count - own, 0), last_s)

    def _wait(self, who: str, free: int, now_s: float) -> float:
        count, last_s = self._failed.get(who, (0, now_s))
        if count < free:
            return 0.0
        pause_s = min(2.0 ** (count - free + 1), self._longest_s)
        return max(0.0, last_s + pause_s - now_s)
