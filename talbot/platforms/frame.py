"""The outline in which a shuttle takes a design: size, ports, names of the supplies."""

from dataclasses import dataclass

from talbot.models.parameters import ParameterError, check_real


@dataclass(frozen=True)
class Frame:
    """An outline with all of its ports on the north edge.

    width_um, height_um: of the outline, from 0, 0. margin_um: least distance of the rows from its edges, x and y.
    ports: bits of the ports with the x (um) of their middles. port_um: width and length of a port, which ends at the
    edge. layer: LEF name of the ports' metal. supplies: names of supply and ground.
    """

    width_um: float
    height_um: float
    margin_um: tuple[float, float]
    ports: tuple[tuple[str, float], ...]
    port_um: tuple[float, float]
    layer: str
    supplies: tuple[str, str]

    def __post_init__(self) -> None:
        for axis, size, margin in zip("xy", (self.width_um, self.height_um), self.margin_um, strict=True):
            check_real(f"margin_um along {axis}", margin, 0.0, size / 2)
        width, length = self.port_um
        check_real("port_um along y", length, 0.01, self.margin_um[1])
        for name, x in self.ports:
            check_real(f"x_um of {name}", x, width / 2, self.width_um - width / 2)
        if len({name for name, _ in self.ports}) != len(self.ports):
            raise ParameterError("ports = a name twice: must be different")

    def core(self, site_um: float, row_um: float) -> tuple[int, int, tuple[float, float]]:
        """Columns and rows, an even number, that fit, and where (x, y in um) they begin, in the middle of the outline.

        On the grid of a hundredth of a micrometre.
        """
        across, along = (size - 2 * margin for size, margin in zip((self.width_um, self.height_um), self.margin_um))
        columns, rows = int(across / site_um + 1e-9), 2 * int(along / row_um / 2 + 1e-9)
        left = (self.width_um - columns * site_um) / 2, (self.height_um - rows * row_um) / 2
        return columns, rows, (round(left[0], 2), round(left[1], 2))
