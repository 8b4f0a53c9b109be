"""The register map: its source and its document agree."""

from importlib import import_module

import pytest

from talbot.models.parameters import MODES
from talbot.models.parameters.registers import register_map

map_module = import_module("talbot.models.parameters.registers.map")

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


@pytest.mark.parametrize("damage", [lambda text: "", lambda text: text[:-9], lambda text: text.replace("busy", "idle")])
def test_the_kept_map_counts_only_where_it_is_whole(tmp_path, monkeypatch, damage):
    monkeypatch.setattr(map_module, "KEPT", tmp_path / "kept" / "map.json")
    whole = register_map.__wrapped__()
    text = map_module.KEPT.read_text()
    assert register_map.__wrapped__() == whole == register_map()
    map_module.KEPT.write_text(damage(text))
    assert register_map.__wrapped__() == whole and map_module.KEPT.read_text() == text
