"""Truth tables as short sums of products, in Liberty's notation (Quine and McCluskey)."""

from collections.abc import Iterable, Sequence
from itertools import combinations

Implicant = tuple[int, int]  # value, and mask of the variables that do not matter


def expression(names: Sequence[str], ones: Iterable[int], free: Iterable[int] = ()) -> str:
    """Return a minimal sum of products: '(A & !B) | C', '1' or '0'.

    names: variables, most significant first. ones: the minterms where it is true; free: where it may be either.
    """
    ones, free = set(ones), set(free)
    if not ones:
        return "0"
    if len(ones | free) == 1 << len(names):
        return "1"
    terms = [_product(names, value, mask) for value, mask in _cover(_primes(ones | free), ones)]
    return terms[0] if len(terms) == 1 else " | ".join(f"({t})" if "&" in t else t for t in terms)


def _primes(minterms: set[int]) -> set[Implicant]:
    terms: set[Implicant] = {(m, 0) for m in minterms}
    primes: set[Implicant] = set()
    while terms:
        merged, used = set(), set()
        for a, b in combinations(terms, 2):
            difference = a[0] ^ b[0]
            if a[1] == b[1] and difference.bit_count() == 1:
                merged.add((a[0] & b[0], a[1] | difference))
                used |= {a, b}
        primes |= terms - used
        terms = merged
    return primes


def _cover(primes: set[Implicant], ones: set[int]) -> list[Implicant]:
    """Choose few primes that cover ``ones``: the essential ones, then always the one that covers most."""
    covers = {p: {m for m in ones if m & ~p[1] == p[0]} for p in sorted(primes)}
    chosen, left = [], set(ones)
    for m in sorted(ones):
        candidates = [p for p in covers if m in covers[p]]
        if len(candidates) == 1 and candidates[0] not in chosen:
            chosen.append(candidates[0])
            left -= covers[candidates[0]]
    while left:
        best = max(covers, key=lambda p: (len(covers[p] & left), p[1].bit_count(), -p[0]))
        chosen.append(best)
        left -= covers[best]
    return sorted(chosen, key=lambda p: (-p[0], p[1]))


def _product(names: Sequence[str], value: int, mask: int) -> str:
    last = len(names) - 1
    return " & ".join(
        ("" if value >> (last - i) & 1 else "!") + name for i, name in enumerate(names) if not mask >> (last - i) & 1
    )
