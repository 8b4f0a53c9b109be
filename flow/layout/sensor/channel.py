"""A channel's trunks on the fewest tracks: the left-edge algorithm [HashimotoStevens1971].

Every pin has a vertical branch to its trunk, and no two branches have the same x, so that there are no vertical
constraints between trunks: any order of the tracks is a routing.
"""

from collections.abc import Collection, Mapping

from talbot.base.steps import StepError


def left_edge(trunks: Mapping[str, tuple[int, int]], gap: int) -> dict[str, int]:
    """Track of each net, from 0: trunks whose spans are nearer than ``gap`` are on different tracks.

    trunks: net -> (low, high). The number of tracks is the largest number of trunks over one x.
    """
    tracks: dict[str, int] = {}
    ends: list[int] = []
    for net, (low, high) in sorted(trunks.items(), key=lambda item: (item[1], item[0])):
        track = next((k for k, end in enumerate(ends) if low - end >= gap), len(ends))
        ends[track : track + 1] = [high]
        tracks[net] = track
    return tracks


def free(wanted: int, taken: Collection[int], pitch: int) -> int:
    """The place nearest to ``wanted`` that is ``pitch`` or more from all in ``taken``."""
    near = [wanted, *(place + way * pitch for place in taken for way in (-1, 1))]
    clear = [place for place in near if all(abs(place - other) >= pitch for other in taken)]
    return min(clear, key=lambda place: (abs(place - wanted), place))


def check_apart(branches: Mapping[tuple[str, str], int], pitch: int) -> None:
    """Raise StepError unless the x of all branches, by (block, pin), are ``pitch`` or more apart."""
    ranked = sorted(branches.items(), key=lambda item: item[1])
    for (one, x), (other, x_other) in zip(ranked, ranked[1:]):
        if x_other - x < pitch:
            pins = f"{' '.join(one)} and {' '.join(other)}"
            raise StepError(f"channel: the pins {pins} are {x_other - x} nm apart in x; {pitch} nm are needed")
