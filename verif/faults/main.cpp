// The chip alone under a waveform: +wave=FILE has a byte of pins for every cycle, +trace=FILE gets three bytes a cycle.
// In: bit 0 sclk, 1 csn, 2 mosi, 3 link_rdy, 4 reset, 5 reset pulses while the clock is low, 6 ... while it is high.
// Outputs before the clock edge: link_data; flags; phases (waveform.py names the bits).
#include <cstdio>
#include "VAspChip.h"
#include "verilated.h"

static void pulse(VAspChip& chip) {     // the other level, and back
  for (int edge = 0; edge < 2; ++edge) {
    chip.reset = !chip.reset;
    chip.eval();
  }
}

int main(int argc, char** argv) {
  VerilatedContext context;
  context.commandArgs(argc, argv);
  VAspChip chip{&context};
  std::FILE* wave = std::fopen(context.commandArgsPlusMatch("wave=") + 6, "rb");
  std::FILE* trace = std::fopen(context.commandArgsPlusMatch("trace=") + 7, "wb");
  if (!wave || !trace) return 3;
  chip.comparator = 0;
  for (int pins = std::fgetc(wave); pins != EOF; pins = std::fgetc(wave)) {
    chip.sclk = pins & 1;
    chip.csn = pins >> 1 & 1;
    chip.mosi = pins >> 2 & 1;
    chip.link_rdy = pins >> 3 & 1;
    chip.reset = pins >> 4 & 1;
    chip.clk = 0;
    chip.eval();
    if (pins >> 5 & 1) pulse(chip);
    const unsigned char out[] = {
        static_cast<unsigned char>(chip.link_data),
        static_cast<unsigned char>(chip.link_val | chip.frame_sync << 1 | chip.busy << 2 | chip.miso << 3 |
                                   chip.hold << 4),
        static_cast<unsigned char>(chip.pixel_reset | chip.shutter << 1 | chip.ref_ctl << 2 | chip.integrate << 3 |
                                   chip.cm_reset << 4 | chip.read << 5 | chip.sample << 6 | (chip.tap != 0) << 7)};
    std::fwrite(out, 1, sizeof out, trace);
    chip.clk = 1;
    chip.eval();
    if (pins >> 6 & 1) pulse(chip);
  }
  return std::fclose(trace);
}
