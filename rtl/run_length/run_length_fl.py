"""RunLength at functional level: the golden encoder at the ports, not cycle-exact."""

from collections import deque

from pymtl3 import Component, update_ff

from talbot.models.digital.stream import StreamHeader, encode_marked, whole_bytes
from talbot.models.digital.stream.trailer import trailer
from talbot.models.parameters import Window, mode_of
from talbot.rtl.messages import END, FRAME, ROW, SAMPLE
from talbot.rtl.run_length.ports import declare_ports


def header_of(s, rows: int, cols: int, lanes: int, tile_rows: int, tile_cols: int) -> StreamHeader:
    """Return the StreamHeader that the ports of ``s`` configure."""
    window = Window(*(int(getattr(s, name)) for name in ("row0", "row1", "col0", "col1")))
    return StreamHeader(
        rows,
        cols,
        lanes,
        tile_rows,
        tile_cols,
        window,
        mode_of(int(s.mode)),
        bool(s.phase),
        int(s.decimation),
        int(s.mask),
        int(s.threshold),
        int(s.frame_number),
        int(s.resync),
        int(s.exposure),
        int(s.n_cm),
        int(s.t_int),
        int(s.calibration),
    )


class RunLengthFL(Component):
    """The ports and parameters of RunLength. A segment's bytes are sent when its last sample is known."""

    def construct(s, *chip):
        declare_ports(s)

        s.out = deque()
        s.header = s.row = None
        s.body = b""
        s.codes = []

        @update_ff
        def behave():
            if s.send.val & s.send.rdy:
                s.out.popleft()
            if s.recv.val & s.recv.rdy:
                s.out.extend(s.take(chip, int(s.recv.msg.kind), int(s.recv.msg.data)))
            if s.reset:
                s.out.clear()
                s.header = s.row = None
            s.recv.rdy <<= not s.out
            s.send.val <<= bool(s.out)
            s.send.msg <<= s.out[0] if s.out else 0
            s.frame_sync <<= bool(s.out) or s.header is not None

    def take(s, chip, kind, data):
        """Return the bytes to send after a message."""
        if s.header is None:
            if kind != FRAME:
                return b""
            s.header, s.body = header_of(s, *chip), b""
            return s.header.to_bytes()
        if kind == SAMPLE:
            s.codes.append(data - (data & 0x80) * 2 if s.header.edge else data)
        if kind not in (ROW, END):
            return b""
        coder = s.header.coder
        if kind == ROW and s.row is not None and whole_bytes(s.codes, *coder) < s.header.segment:
            return b""
        sent = b"" if s.row is None else encode_marked(s.row, s.codes, *coder)
        s.body += sent
        s.row, s.codes = data, []
        if kind == END:
            sent += trailer(s.header.to_bytes(), s.body, int(s.made), int(s.left_out))
            s.header = s.row = None
        return sent

    def line_trace(s):
        return f"{len(s.out):3}"
