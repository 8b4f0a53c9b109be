"""The page's first figures."""

import pytest

from talbot.pixels.pixel_layout.page import _tiles, waivers

pytestmark = pytest.mark.needs("layout")

SUMMARY = {
    "drc_violations": 0,
    "lvs_match": {"tile": True},
    "fill_factor": 0.4,
    "gds_bytes": 1,
    "pixels": 9,
    "gds_s": 1,
}


@pytest.mark.parametrize("count, kind", [(4208, "none"), (0, "good")])
def test_waived_violations_are_listed_separately(count, kind):
    s = SUMMARY | {"waivers": {"x.2": {"count": count, "reason": "oblique lines"}} if count else {}}
    tile = _tiles(s)[0]
    assert (tile.value, tile.kind) == ("0", kind)
    assert ("4,208 more are waived (x.2)" in tile.label) == bool(count) == (waivers(s) != "")


def test_a_violation_that_is_not_waived_is_bad():
    assert _tiles(SUMMARY | {"drc_violations": 3, "waivers": {}})[0].kind == "bad"
