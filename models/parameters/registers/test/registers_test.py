"""The register map: its source and its document agree."""

from talbot.models.parameters import MODES
from talbot.models.parameters.registers import register_map

CHIP = register_map()


def test_the_modes_are_those_of_a_frame():
    assert CHIP["mode"].choices == tuple(enumerate(MODES))


def test_no_two_fields_share_a_bit():
    seen = set()
    for f in CHIP.fields:
        bits = {(f.byte + (f.shift + i) // 8, (f.shift + i) % 8) for i in range(f.width)}
        assert not bits & seen, f.key
        assert f.lsb + f.width <= 8 * f.size
        seen |= bits
    assert max(address for address, _ in seen) < 128


def test_the_configuration_is_one_run_of_addresses_of_its_own():
    """The RTL locks it, and places the counters, by address range."""
    ours = CHIP.writable()
    others = {f.byte + i for f in CHIP.fields if f.access != "rw" for i in range(f.bytes)}
    assert not others & set(range(min(ours), max(ours) + 1))
    assert [f.byte for f in CHIP.counters] == [CHIP.counters[0].byte + 8 * i for i in range(3)]
    assert CHIP.counters[0].byte % 8 == 0
    sticky = [f for f in CHIP.fields if f.access == "w1c"]
    assert [f.shift for f in sticky] == list(range(sticky[0].shift, sticky[0].shift + len(sticky)))
    assert all(f.width == 1 and f.register == "status" for f in sticky)
