"""What the documents name can be built. Each test imports the parameters itself and fails where these refuse it.

Not next to the parameters: importing their package imports them.
"""


def test_the_default_chip():
    from talbot.models.parameters import LANES, ChipParameters

    assert ChipParameters().lanes == 8  # docs/host.md
    assert [ChipParameters(lanes=lanes).lanes for lanes in (1, 2, 4, 8, 16, 32)] == [*LANES]


def test_the_first_tile():
    from talbot.models.parameters import Window

    assert Window(0, 0, 0, 0).row1 == 0  # docs/registers.md: row0, row1, col0, col1


def test_the_shortest_slot():
    from talbot.models.parameters import AmpTiming

    timing = AmpTiming(1, 1, 1, 1, 1, 1, n_cm=0, exposure=0)  # docs/registers.md: t_reset to t_guard, n_cm, exposure
    assert timing.t_guard == 1 and timing.n_cm == timing.exposure == 0
