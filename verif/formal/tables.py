"""Tables of the golden models as Verilog functions for the wrappers of proofs."""

from collections.abc import Iterable

import numpy as np

from models.digital.divider import quad_divide
from models.parameters.divider import cordic_angles
from models.parameters.registers import register_map

from .proof import Proof


def case(name: str, in_bits: int, out_bits: int, values: Iterable[int]) -> str:
    """Return a Verilog function that looks ``values`` up by index."""
    lines = "".join(f"    {in_bits}'d{i}: {name} = {out_bits}'d{value};\n" for i, value in enumerate(values))
    return (
        f"function [{out_bits - 1}:0] {name}(input [{in_bits - 1}:0] at);\n  case (at)\n{lines}"
        f"    default: {name} = 0;\n  endcase\nendfunction\n"
    )


def phase_of_ratio(proof: Proof) -> str:
    """Return phase_of_ratio(ratio): LSB from the octant's axis, by the golden divider on a vector of that ratio."""
    bits = proof.sensor_parameters.chip.n_frac
    larger, smaller = np.meshgrid(np.arange(1, 256), np.arange(256), indexing="ij")
    inside = smaller < larger
    found = quad_divide(larger[inside], smaller[inside], bits)
    table = dict(zip(found.ratio.tolist(), found.phase.tolist()))
    top = quad_divide(1, 1, bits)  # the diagonal: octant 1, counted back from the axis at 64
    table[int(top.ratio)] = 64 - int(top.phase)
    return case("phase_of_ratio", bits, 8, [table.get(r, 0) for r in range(1 << bits)])


def cordic_angle(proof: Proof) -> str:
    """Return cordic_angle(i): atan(2^-(i + 1)) in the units of the golden CORDIC."""
    iterations = proof.sensor_parameters.chip.cordic_iterations
    return case("cordic_angle", 4, 5 + iterations, cordic_angles(iterations))


def type_at(proof: Proof) -> str:
    """Return type_at(position): the pixel type at a position of the tile, row by row."""
    order = proof.sensor_parameters.tile.order
    return case("type_at", 5, 5, order)


def registers(proof: Proof) -> str:
    """Return bit_address, bit_place, bit_writable and bit_reset of each bit of the configuration, and macros."""
    chip, sensor = register_map(), proof.sensor_parameters
    resets = {"row1": sensor.tile_rows - 1, "col1": sensor.tile_cols - 1}
    bits = []  # from the struct's lowest bit: (address, place, writable, reset)
    writable = chip.writable()
    for f in chip.trims:
        for i in range(8 * f.size):
            address = f.address + i // 8
            bits.append((address, i % 8, writable.get(address, 0) >> i % 8 & 1, f.reset >> i & 1))
    for f in reversed([f for f in chip.configuration if f.name != "trim"]):
        for i in range(f.width):
            at = f.lsb + i
            bits.append((f.address + at // 8, at % 8, 1, resets.get(f.name, f.reset) >> i & 1))
    columns = [
        case(name, 10, width, column)
        for (name, width), column in zip(
            (("bit_address", 7), ("bit_place", 3), ("bit_writable", 1), ("bit_reset", 1)), zip(*bits)
        )
    ]
    image = [address for address, *_ in bits]
    macros = {
        "CFG_BITS": len(bits),
        "FIRST": min(image),
        "LAST": max(image),
        "START": chip["start"].byte,
        "STATUS": chip["busy"].byte,
        "LOOP": chip["loop_back"].byte,
        "CYCLES": chip["cycles"].byte,
    }
    return "".join(f"`define {name} {value}\n" for name, value in macros.items()) + "".join(columns)


TABLES = {"type_at": type_at, "registers": registers, "phase_of_ratio": phase_of_ratio, "cordic_angle": cordic_angle}
