"""An example of every project's program: the chip's registers are written by the host's golden functions."""

from collections.abc import Sequence

from talbot.models.digital.host import command, frame_writes, write_transfers
from talbot.models.parameters import AmpTiming, FrameParameters, Window
from talbot.rtl.tinytapeout.host import divisions, frame, row


def transfers(frame: FrameParameters, trims: Sequence[int]) -> list[bytes]:
    """Return SPI transfers that configure and start a frame. trims: registers by pixel type."""
    return [*write_transfers(frame_writes(frame, trims)), command("start")]


# A time-of-flight frame with phases, which uses every block, of four tiles of the test pattern
PATTERN_FRAME = FrameParameters(
    Window(1, 2, 1, 2), "tof", phase=True, test_pattern=True, timing=AmpTiming(2, 9, 2, 2, 3, 1, 1)
)
EXAMPLES = {
    "tt_um_talbot_divider": divisions(
        [
            (0, 0, 0),
            (100, 100, 0),
            (-256, 255, 3),
            (255, -17, 9),
            (-31, -200, 63),
            (88, 3, 1),
            (-5, 6, 0),
            (0, -256, 20),
        ]
    ),
    "tt_um_talbot_amp_ctrl": row(AmpTiming(9, 60, 4, 5, 6, 7, 3), True, 1023),
    "tt_um_talbot_chip": frame(transfers(PATTERN_FRAME, [0] * 24), 8000),
}
