"""asp_chip.c as a class with the methods of rtl.host.driver.Host."""

import ctypes
import subprocess
from ctypes import CFUNCTYPE, POINTER, Structure, byref, c_int, c_int16, c_size_t, c_uint8, c_uint16, c_uint32, c_uint64
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from talbot.models.parameters.registers import register_map
from talbot.rtl.host.driver import Code, Host, HostError

FOLDER = Path(__file__).parents[1]
CHIP = register_map()
STRICT = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-O2")
ROOM = 60_000
OK, TRANSFER, OUT_OF_ROOM = 0, 1, 11


@cache
def library():
    with TemporaryDirectory(prefix="talbot-") as folder:
        path = f"{folder}/asp_chip.so"
        subprocess.run(["gcc", *STRICT, "-shared", "-fPIC", FOLDER / "asp_chip.c", "-o", path], check=True)
        return ctypes.CDLL(path)


def structure(name, fields):
    return type(name, (Structure,), {"_fields_": fields})


Transfer = CFUNCTYPE(c_int, c_size_t, POINTER(c_uint8), POINTER(c_uint8), c_size_t)
Link = CFUNCTYPE(c_int, c_size_t)
Now = CFUNCTYPE(c_uint32, c_size_t)
Identity = structure("Identity", [(f.name, c_uint16) for f in CHIP.identity])
Configuration = structure(
    "Configuration",
    [(f.name, c_uint32) for f in CHIP.configuration if f.name != "trim"] + [("trim", c_int16 * len(CHIP.trims))],
)
Counters = structure("Counters", [(f.name, c_uint64) for f in CHIP.counters])
Chip = structure(
    "Chip", [("context", c_size_t), ("transfer", Transfer), ("link", Link), ("now", Now), ("identity", Identity)]
)


def numbers(filled):
    return {name: getattr(filled, name) for name, *_ in filled._fields_}


class CHost:
    """See Host. room: of the buffer for a frame."""

    def __init__(self, transfer, link, now, room=ROOM):
        self.chip, self.room, held = Chip(), room, bytearray()

        def on_transfer(context, out, into, count):
            answer = transfer(bytes(out[:count]))
            if len(answer) != count:
                return 1
            if into:
                ctypes.memmove(into, answer, count)
            return 0

        def on_link(context):
            if not held:
                held.extend(link())
            return held.pop(0) if held else -1

        self.chip.transfer, self.chip.link = Transfer(on_transfer), Link(on_link)
        self.chip.now = Now(lambda context: int(now()) % 2**32)

    def call(self, name, *arguments):
        code = getattr(library(), f"asp_{name}")(byref(self.chip), *arguments)
        if code in (TRANSFER, OUT_OF_ROOM):
            raise OSError(code, name)
        if code != OK:
            raise HostError(Code(code), name)

    def identify(self):
        self.call("identify")
        return numbers(self.chip.identity)

    def defaults(self):
        values = Configuration()
        library().asp_defaults(byref(self.chip), byref(values))
        out = numbers(values)
        return out | {f.key: trim for f, trim in zip(CHIP.trims, out.pop("trim"))}

    def configure(self, values):
        wanted = Configuration()
        for key, value in (self.defaults() | values).items():
            if key.startswith("trim"):
                wanted.trim[[f.key for f in CHIP.trims].index(key)] = value
            else:
                setattr(wanted, key, value)
        self.call("configure", byref(wanted))

    def start(self):
        self.call("start")

    def wait(self, limit):
        self.call("wait", c_uint32(limit))

    def frame(self, limit):
        buffer, length = (c_uint8 * self.room)(), c_size_t()
        self.call("frame", buffer, c_size_t(self.room), byref(length), c_uint32(limit))
        return bytes(buffer[: length.value])

    def abort(self):
        self.call("abort")

    def status(self):
        status = c_uint8()
        self.call("status", byref(status))
        return {f.name: bool(status.value >> f.shift & 1) for f in CHIP.fields if f.register == "status"}

    def counters(self):
        counters = Counters()
        self.call("counters", byref(counters))
        return numbers(counters)

    def loop_back(self, data, limit):
        self.call("loop_back", bytes(data), c_size_t(len(data)), c_uint32(limit))

    def read(self, address, count):
        buffer = (c_uint8 * count)()
        self.call("read", c_uint8(address), buffer, c_size_t(count))
        return bytes(buffer)

    def write(self, writes):
        for address, byte in writes:
            self.call("write", c_uint8(address), bytes((byte,)), c_size_t(1))


assert all(hasattr(CHost, name) for name in vars(Host) if not name.startswith("_"))
