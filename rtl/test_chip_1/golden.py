"""The golden chip: the bytes of the host against memory, the sorter and the golden processor."""

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field

from talbot.rtl.proc.golden import Access, Execution, Fetch, Memory, Receive, Send, execution
from talbot.rtl.proc.isa import signed

WORDS = 4096  # of memory
WRITE, REGISTER = 0x8000, 0x4000  # bits of a header's address
CONTROL, CHANNEL = REGISTER, REGISTER | 1
RUNS, HALTED, WORD_WAITS, PROC_WAITS = 1, 2, 4, 8  # bits of the status
SORTER = 0x8000  # addresses of the processor from here on


def header(address: int, words: int) -> bytes:
    """Return the four bytes ahead of ``words`` words. address: of a word, with the bits WRITE and REGISTER."""
    return address.to_bytes(2, "little") + words.to_bytes(2, "little")


def words_of(data: bytes) -> list[int]:
    """Return the words of ``data``."""
    return [int.from_bytes(data[i : i + 4], "little") for i in range(0, len(data), 4)]


def bytes_of(words: Iterable[int]) -> bytes:
    """Return the bytes of ``words``."""
    return b"".join(word.to_bytes(4, "little") for word in words)


@dataclass
class GoldenChip:
    """TestChip1 without time: the processor goes on until it needs a word of the host or has one for it.

    words: of memory. fetched: instructions so far. sorted_: number of words that the sorter sorted last.
    """

    words: int = WORDS
    memory: Memory = field(default_factory=Memory)
    runs: bool = False
    execute: Execution | None = None
    request: object = None
    sorted_: int = 0
    fetched: int = 0

    def host(self, sent: bytes) -> bytes:
        """Return the bytes that answer the transfers ``sent``, all whole."""
        data, answer = deque(sent), b""
        while data:
            address, count = (data.popleft() | data.popleft() << 8 for _ in range(2))
            for n in range(count):
                place = address if address & REGISTER else address & ~0xFFF | address + n & 0xFFF
                if address & WRITE:
                    self.write(place, int.from_bytes(bytes(data.popleft() for _ in range(4)), "little"))
                else:
                    answer += self.read(place).to_bytes(4, "little")
        return answer

    def write(self, address: int, word: int) -> None:
        """Write a word of the host."""
        if not address & REGISTER:
            self.access(15, 4 * (address & 0xFFF), word)
        elif address & 1:
            assert isinstance(self.request, Receive)
            self.advance(word)
            self.proceed()
        else:
            if not word & 1:
                self.execute = self.request = None
            elif not self.runs:
                self.execute = execution()
                self.request = next(self.execute)
                self.proceed()
            self.runs = bool(word & 1)

    def read(self, address: int) -> int:
        """Return a word for the host."""
        if not address & REGISTER:
            return self.access(0, 4 * (address & 0xFFF), 0)
        if address & 1:
            assert isinstance(self.request, Send)
            word = self.request.word
            self.advance(0)
            self.proceed()
            return word
        halted = self.runs and self.request is None
        waits = WORD_WAITS * isinstance(self.request, Send) | PROC_WAITS * isinstance(self.request, Receive)
        return RUNS * self.runs | HALTED * halted | waits

    def access(self, strobe: int, address: int, data: int) -> int:
        """Return the word of memory at ``address``, then write its bytes of ``strobe``."""
        return self.memory.access(strobe, address % (4 * self.words) & ~3, data)

    def advance(self, answer: int) -> None:
        """Answer the processor's request, and go on."""
        try:
            assert self.execute is not None
            self.request = self.execute.send(answer)
        except StopIteration:
            self.request = None

    def proceed(self) -> None:
        """Go on until the processor stops or waits for the host."""
        while isinstance(request := self.request, (Fetch, Access)):
            if isinstance(request, Fetch):
                self.fetched += 1
                self.advance(self.access(0, request.address, 0))
            elif request.address & SORTER:
                if request.strobe:
                    self.sort(request.data & 0xFFF, request.data >> 16 & 0xFFF)
                self.advance(self.sorted_)
            else:
                self.advance(self.access(request.strobe, request.address, request.data))

    def sort(self, address: int, length: int) -> None:
        """Sort ``length`` words at the word ``address``, through those that follow them."""
        places = [4 * (address + n) for n in range(length)]
        words = sorted((self.access(0, place, 0) for place in places), key=signed)
        for place, word in zip(places, words, strict=True):
            self.access(15, place, word)
        self.sorted_ = length
