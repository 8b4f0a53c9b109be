"""A channel's trunks on as few tracks as there can be: the left-edge algorithm [HashimotoStevens1971].

Every pin of a net reaches the channel on a vertical of its own, no two of which have the same place, so that no trunk
forces another above or below it: any order of the tracks is a routing.
"""

from base.steps import StepError


def left_edge(trunks, gap):
    """dict net -> track, from 0: trunks whose spans come nearer than ``gap`` are on different tracks.

    trunks: dict net -> (low, high). There are as many tracks as trunks over the fullest place.
    """
    tracks, ends = {}, []
    for net, (low, high) in sorted(trunks.items(), key=lambda item: (item[1], item[0])):
        track = next((k for k, end in enumerate(ends) if low - end >= gap), len(ends))
        ends[track : track + 1] = [high]
        tracks[net] = track
    return tracks


def free(wanted, taken, pitch):
    """The place nearest to ``wanted`` that is ``pitch`` or more from all in ``taken``."""
    near = [wanted, *(place + way * pitch for place in taken for way in (-1, 1))]
    return min(
        (place for place in near if all(abs(place - other) >= pitch for other in taken)),
        key=lambda place: (abs(place - wanted), place),
    )


def check_apart(verticals, pitch):
    """Raise StepError unless the verticals, dict what -> x, are ``pitch`` or more from one another."""
    ranked = sorted(verticals.items(), key=lambda item: item[1])
    for (one, x), (other, x_other) in zip(ranked, ranked[1:]):
        if x_other - x < pitch:
            raise StepError(
                f"channel: the pins {' '.join(one)} and {' '.join(other)} are {x_other - x} nm from one "
                f"another in x; {pitch} nm are needed"
            )
