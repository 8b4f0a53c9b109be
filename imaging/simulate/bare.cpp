// The chip alone in a bare clock loop: no front end, no host, no files. What Bench may cost is measured against it.
// The registers are written over SPI from +script=FILE (as in bench.sv, up to its wait), with the test pattern on.
#include <chrono>
#include <cstdio>
#include <vector>
#include "VAspChip.h"
#include "verilated.h"

static VAspChip* chip;
static unsigned long long cycles = 0;

static void evaluate() { VAspChip___024root___eval(chip->rootp); }

static void tick() {
  chip->clk = 0;
  evaluate();
  chip->clk = 1;
  evaluate();
  ++cycles;
}

static void send(unsigned byte) {
  for (int bit = 7; bit >= 0; --bit) {
    chip->mosi = byte >> bit & 1;
    for (int i = 0; i < 8; ++i) tick();
    chip->sclk = 1;
    for (int i = 0; i < 8; ++i) tick();
    chip->sclk = 0;
  }
}

int main(int argc, char** argv) {
  VerilatedContext context;
  context.commandArgs(argc, argv);
  chip = new VAspChip{&context};
  std::FILE* script = std::fopen(context.commandArgsPlusMatch("script=") + 8, "rb");
  if (!script) return 3;
  chip->csn = 1;
  chip->link_rdy = 1;
  chip->reset = 1;
  chip->eval();
  for (int i = 0; i < 4; ++i) tick();
  chip->reset = 0;
  while (std::fgetc(script) == 2) {
    chip->csn = 0;
    for (int left = std::fgetc(script); left > 0; --left) send(std::fgetc(script));
    for (int i = 0; i < 8; ++i) tick();
    chip->csn = 1;
    for (int i = 0; i < 16; ++i) tick();
  }
  cycles = 0;
  const auto start = std::chrono::steady_clock::now();
  do tick(); while (chip->busy && cycles < 1000000000ULL);
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  std::printf("{\"cycles\": %llu, \"seconds\": %.9f}\n", cycles, spent.count());
  delete chip;
  return 0;
}
