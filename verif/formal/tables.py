"""Tables of the golden models as Verilog functions for the wrappers of proofs."""

from collections.abc import Iterable

import numpy as np

from talbot.models.digital.divider import quad_divide
from talbot.models.parameters.divider import cordic_angles
from talbot.models.parameters.registers import array_resets, register_map
from talbot.rtl.quad_divider import timing
from talbot.verif.formal.proof import Proof


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
    result = quad_divide(larger[inside], smaller[inside], bits)
    table = dict(zip(result.ratio.tolist(), result.phase.tolist()))
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


def geometry(proof: Proof) -> str:
    """Return the sizes of the sensor as macros."""
    sensor = proof.sensor_parameters
    array, tile = sensor.array, sensor.tile
    sizes = {"ROWS": array.rows, "COLS": array.cols, "TILE_ROWS": tile.rows, "TILE_COLS": tile.cols}
    return _macros(sizes | {"LANES": sensor.chip.lanes})


def _macros(values: dict[str, int]) -> str:
    return "".join(f"`define {name} {value}\n" for name, value in values.items())


def registers(proof: Proof) -> str:
    """Return the register map as functions and macros.

    bit_address, bit_place, bit_writable and bit_reset of each bit of the configuration; writable_at and constant_at of
    each address; STATE_WORD, the bytes of the register `state`, from input ``state``.
    """
    chip, sensor = register_map(), proof.sensor_parameters
    array, tile, build = sensor.array, sensor.tile, sensor.chip
    resets = array_resets(array.rows, array.cols, build.lanes, tile.rows, tile.cols, build.divider)
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
        "ABORT_BIT": chip["abort"].shift,
        "STATUS": chip["busy"].byte,
        "LOOP": chip["loop_back"].byte,
        "CYCLES": chip["cycles"].byte,
        "STATE": chip.state[0].address,
    }
    constants = chip.image(chip.identity, resets)
    columns += [
        case(name, 7, 8, [table.get(address, 0) for address in range(128)])
        for name, table in (("writable_at", writable), ("constant_at", constants))
    ]
    state, past = ["1'b0"] * 32, sum(f.width for f in chip.state)
    for f in chip.state:  # the first one is highest in the struct
        past -= f.width
        state[f.lsb : f.lsb + f.width] = [f"state[{past + i}]" for i in range(f.width)]
    return f"{_macros(macros)}`define STATE_WORD {{{', '.join(reversed(state))}}}\n{''.join(columns)}"


def lane_registers(proof: Proof) -> str:
    """Return macro LANE_REGISTERS of AdcBank's wrapper: states, fulls, codes and converted, packed, lane 0 lowest."""
    lanes = proof.sensor_parameters.chip.lanes
    wires = []
    for packed, (name, width) in {
        "states": ("state", 3),
        "fulls": ("full", 1),
        "codes": ("code", 8),
        "converted": ("search_made", 1),
    }.items():
        names = [f"lane{lane}.{name}" for lane in reversed(range(lanes))]
        wires.append(_connected(dict.fromkeys(names, width)))
        wires.append(f"wire [{width * lanes - 1}:0] {packed} = {{{', '.join(map(_inside, names))}}};")
    return f"`define LANE_REGISTERS {' '.join(wires)}\n"


def phase_path(proof: Proof) -> str:
    """Return ENTRIES, DIVIDER and CYCLES: wires to the state of PhasePath's store and divider, for its wrapper."""
    chip = proof.sensor_parameters.chip
    steps = timing(chip.divider, chip.n_frac, chip.cordic_iterations)[0] - 1
    values = {
        f"store.entry{i}.value_{xy}": bits for i in reversed(range(chip.lanes)) for xy, bits in (("x", 9), ("y", 8))
    }
    entries = f"{_connected(values)} wire [{17 * chip.lanes - 1}:0] entries = {{{', '.join(map(_inside, values))}}};"
    if chip.divider == "pipelined":
        names = [f"divider.stage{i}.out_val" for i in reversed(range(steps + 1))]
        remaining = "".join(f"{_inside(name)} ? {i} : " for i, name in enumerate(names)) + "0"
        held, sound, state = " + ".join(map(_inside, names)), "1", dict.fromkeys(names, 1)
    else:
        state = {"divider.ctrl.running": 1, "divider.ctrl.done": 1}
        running, done = map(_inside, state)
        count = f"divider.dpath.{'i' if chip.divider == 'cordic' else 'count'}"
        state[count] = 4
        held, remaining = f"{running} + {done}", f"{done} ? 0 : {steps} - {_inside(count)}"
        sound = f"!({running} && {done}) && (!{running} || {_inside(count)} < {steps})"
    divider = f"{_connected(state)} wire [4:0] held = {held}; wire [4:0] left = {remaining}; wire sound = {sound};"
    return f"`define ENTRIES {entries}\n`define DIVIDER {divider}\n`define CYCLES {steps}\n"


def _inside(name: str) -> str:
    return f"\\dut.{name} "


def _connected(widths: dict[str, int]) -> str:
    return " ".join(f"(* hierconn *) wire [{bits - 1}:0] {_inside(name)};" for name, bits in widths.items())


TABLES = {
    "type_at": type_at,
    "geometry": geometry,
    "phase_path": phase_path,
    "registers": registers,
    "phase_of_ratio": phase_of_ratio,
    "cordic_angle": cordic_angle,
    "lane_registers": lane_registers,
}
