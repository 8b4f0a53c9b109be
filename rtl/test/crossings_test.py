"""The asynchronous pins pass synchronizers; a missing flip-flop and a raw pin are found."""

import pytest

from talbot.models.parameters import ASYNCHRONOUS, ArrayParameters, ChipParameters, SensorParameters
from talbot.rtl.crossings import crossings
from talbot.rtl.export import translate

pytestmark = pytest.mark.needs("yosys")

GOOD = """
module Top (input clk, input reset, input sclk, input csn, input mosi, output miso_oe, output reg miso);
  reg [1:0] a, b, c, d;
  wire \\resets.chip = reset | d[1];
  assign miso_oe = !csn && !\\resets.chip ;
  always @(posedge clk) begin
    a <= {a[0], sclk}; b <= {b[0], csn}; c <= {c[0], mosi}; d <= {d[0], reset};
    miso <= \\resets.chip ? 0 : a[1] && !b[1] && c[1];
  end
endmodule
"""


@pytest.mark.parametrize(
    "find, replace, problem",
    [
        ("", "", None),
        ("a[1] &&", "a[0] &&", "sclk = 1 first flip-flops: must have one, which only a second one reads"),
        ("c[1];", "mosi;", "mosi = read by miso: must pass a synchronizer"),
        ("{b[0], csn}", "{b[0], csn & sclk}", "csn = read by b: must pass a synchronizer"),
        ("{c[0], mosi}", "{c[0] & sclk, mosi}", "sclk = read by c: must pass a synchronizer"),
        ("? 0 :", "? csn :", "csn = read by miso: must pass a synchronizer"),
        ("{d[0], reset}", "{reset, d[1]}", "reset = 1 first flip-flops: must have one, which only a second one reads"),
    ],
)
def test_a_pin_without_its_synchronizer_is_found(find, replace, problem, tmp_path):
    (tmp_path / "top.v").write_text(GOOD.replace(find, replace) if find else GOOD)
    found = crossings(tmp_path / "top.v", "Top")
    assert (problem in found) if problem else not found, found


def test_the_chips_synchronizers_survive_synthesis(chip, tmp_path):
    """After Yosys's optimizations, with the attribute that the export has."""
    assert '(* keep, async_reg = "true" *) logic [1:0] stages;' in chip
    (tmp_path / "chip.v").write_text(chip)
    assert not crossings(tmp_path / "chip.v", "AspChip", "proc; flatten; opt -full")


def test_a_chip_with_one_flip_flop_less_is_found(chip, tmp_path):
    assert "assign out = stages[1:1];" in chip
    (tmp_path / "chip.v").write_text(chip.replace("assign out = stages[1:1];", "assign out = stages[0:0];"))
    found = crossings(tmp_path / "chip.v", "AspChip")
    assert [line.split(" = ")[0] for line in found] == list(ASYNCHRONOUS)


@pytest.fixture(scope="module")
def chip():
    sensor = SensorParameters(array=ArrayParameters(8, 13), chip=ChipParameters(lanes=1))
    return translate("AspChip", sensor)
