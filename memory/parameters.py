"""Size of a static RAM."""

from dataclasses import dataclass

from talbot.models.parameters import ParameterError, check_int


@dataclass(frozen=True)
class SramParameters:
    """A static RAM with one port.

    Attributes
    ----------
    words : int
        Words, 128..1024, a power of two.
    bits : int
        Bits of a word, 1..64.
    mux : int
        Columns that share a sense amplifier: 8, as wide as its circuits are drawn.
    """

    words: int = 512
    bits: int = 32
    mux: int = 8

    def __post_init__(self) -> None:
        check_int("words", self.words, 128, 1024)
        check_int("bits", self.bits, 1, 64)
        if self.words & (self.words - 1):
            raise ParameterError(f"words = {self.words}: must be a power of two")
        if self.mux != 8:
            raise ParameterError(f"mux = {self.mux}: must be 8")

    @property
    def rows(self) -> int:
        """Word lines."""
        return self.words // self.mux

    @property
    def columns(self) -> int:
        """Pairs of bit lines."""
        return self.bits * self.mux

    @property
    def address_bits(self) -> int:
        """Bits of an address."""
        return self.words.bit_length() - 1
