// The chip's pins for a host in the same process: SPI in bits at f_clk / 8, a receiver on the link, the reset pin.
#include <cstddef>
#include <cstdint>
#include <deque>

#include "VAspChip.h"
#include "verilated.h"

namespace {
VerilatedContext context;
VAspChip chip{&context};
std::deque<std::uint8_t> received;
std::uint32_t cycles = 0, noise = 1, stall = 0;     // stall: of 256 cycles, those in which the receiver is not ready

void tick() {
  noise = noise * 1664525u + 1013904223u;
  chip.link_rdy = (noise >> 24) >= stall;
  chip.clk = 0;
  chip.eval();
  if (chip.link_val && chip.link_rdy) received.push_back(chip.link_data);
  chip.clk = 1;
  chip.eval();
  ++cycles;
}
}  // namespace

extern "C" {
void bench_ticks(std::uint32_t count) {
  while (count--) tick();
}

void bench_reset(std::uint32_t count) {
  chip.sclk = 0;
  chip.csn = 1;
  chip.mosi = 0;
  chip.comparator = 0;
  chip.reset = 1;
  bench_ticks(count);
  chip.reset = 0;
  bench_ticks(12);
  received.clear();
}

void bench_stall(std::uint32_t of_256) { stall = of_256; }

// busy, frame_sync, link_val
std::uint32_t bench_pins() { return chip.busy | chip.frame_sync << 1 | chip.link_val << 2; }

// 1: miso_oe is not high for the transfer and low before and after it.
int bench_transfer(const std::uint8_t* out, std::uint8_t* in, std::size_t n) {
  bool driven = !chip.miso_oe;
  chip.csn = 0;
  bench_ticks(4);
  for (std::size_t i = 0; i < n; ++i) {
    unsigned answer = 0;
    for (int bit = 7; bit >= 0; --bit) {
      chip.mosi = out[i] >> bit & 1;
      bench_ticks(4);
      answer = answer << 1 | chip.miso;
      driven &= chip.miso_oe;
      chip.sclk = 1;
      bench_ticks(4);
      chip.sclk = 0;
    }
    in[i] = static_cast<std::uint8_t>(answer);
  }
  bench_ticks(4);
  chip.csn = 1;
  bench_ticks(8);
  return !(driven && !chip.miso_oe);
}

int bench_link() {
  tick();
  if (received.empty()) return -1;
  const int byte = received.front();
  received.pop_front();
  return byte;
}

std::uint32_t bench_now() { return cycles; }
}
