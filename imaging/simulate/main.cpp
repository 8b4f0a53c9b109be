// Clocks Bench in Verilator until it is done; writes what it took to +stats=FILE as JSON.
// With tracing compiled in, +waves=FILE +waves_row0=N +waves_row1=N dump the cycles that convert those rows.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include "VBench.h"
#include "verilated.h"
#ifdef WAVES_VCD
#include "verilated_vcd_c.h"
using Waves = VerilatedVcdC;
#endif
#ifdef WAVES_FST
#include "verilated_fst_c.h"
using Waves = VerilatedFstC;
#endif

static long argument(VerilatedContext& context, const char* name, long fallback) {
  const char* text = context.commandArgsPlusMatch(name);
  return text && *text ? std::atol(text + std::strlen(name) + 1) : fallback;
}

static const char* path(VerilatedContext& context, const char* name) {
  static char text[4096];
  const char* match = context.commandArgsPlusMatch(name);
  if (!match || !*match) return nullptr;
  std::snprintf(text, sizeof text, "%s", match + std::strlen(name) + 1);
  return text;
}

// A rising edge. VBench::eval() less its locks around message queues, which one thread does not need; once the reset is
// over also less what settles other inputs than the clock: together a seventh of the time. The model is part of this
// translation unit, and has one kind of event, this edge.
static void rise(VBench& top, bool settled) {
  top.clk = 1;
#ifdef WAVES
  top.eval();       // it also marks what changed, for the trace
#else
  if (settled) return VBench___024root___nba_sequent__TOP__0(top.rootp);
  top.rootp->__Vtrigprevexpr___TOP__clk__0 = 0;
  VBench___024root___eval(top.rootp);
#endif
}

int main(int argc, char** argv) {
  VerilatedContext context;
  context.commandArgs(argc, argv);
  const std::uint64_t limit = argument(context, "max_cycles=", 1000000000L);
#ifdef WAVES
  context.traceEverOn(true);
#endif
  VBench top{&context};
#ifdef WAVES
  const unsigned row0 = argument(context, "waves_row0=", 0), row1 = argument(context, "waves_row1=", 0);
  Waves waves;
  top.trace(&waves, 99);
  const char* dumped = path(context, "waves=");
  if (dumped) waves.open(dumped);
#endif
  std::uint64_t cycles = 0;
  top.reset = 1;
  top.eval();       // the initial blocks: reading the frame's files is not part of the clock loop
  const auto start = std::chrono::steady_clock::now();
  while (!top.done && !context.gotFinish() && top.cycles < limit) {
#ifdef WAVES
    top.clk = 0;
    top.eval();
    const bool dump = dumped && top.row >= row0 && top.row <= row1;
    if (dump) waves.dump(2 * cycles);
#endif
    rise(top, cycles > 4);
#ifdef WAVES
    if (dump) waves.dump(2 * cycles + 1);
#endif
    if (++cycles == 4) top.reset = 0;
  }
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  top.final();
#ifdef WAVES
  if (dumped) waves.close();
#endif
  if (const char* name = path(context, "stats=")) {
    std::FILE* stats = std::fopen(name, "w");
    if (!stats) return 3;
    std::fprintf(stats, "{\"seconds\": %.9f}\n", spent.count());
    std::fclose(stats);
  }
  return top.done ? 0 : 4;
}
