// Recorded cycles driven into verilated Verilog:
// `program TRACE [--points FILE] [--states FILE] [--mutants FIRST LAST]`.
//
// TRACE: lines 'fresh inputs outputs' (rtl/replay/trace.py). Writes 'number cycle' for each run to stdout: first cycle
// with an output that differs from the trace, or -1. Without --mutants there is one run, number 0; with it, a run for
// every value FIRST..LAST of the input `mutant`, a fresh model each, to its first difference.
// --points: Verilator's coverage; FILE.first has it after the first cycle, in which constants take their values.
// --states: lines 'register reset from to times', of registers in consecutive cycles.
// `program --drive MUTANT [--settled]`: reads lines from stdin and writes the outputs (rtl/harness/icarus.py), those
// before the first edge as 0 unless --settled.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "VDut.h"
#include "VDut___024root.h"
#include "verilated.h"
#if VM_COVERAGE
#include "verilated_cov.h"
#endif

using Words = std::vector<std::uint32_t>;

static std::uint64_t bits(const Words& from, int low, int width) {
  std::uint64_t value = 0;
  for (int i = low / 32, at = -(low % 32); at < width; ++i, at += 32) {
    const std::uint64_t word = from[i];
    value |= at < 0 ? word >> -at : word << at;
  }
  return width == 64 ? value : value & ((std::uint64_t{1} << width) - 1);
}

template <class Wide>
static void set_wide(Wide& to, const Words& from, int low, int width) {
  for (int i = 0; i * 32 < width; ++i) to[i] = bits(from, low + 32 * i, width - 32 * i < 32 ? width - 32 * i : 32);
}

template <class Wide>
static bool same_wide(const Wide& of, const Words& want, int low, int width) {
  for (int i = 0; i * 32 < width; ++i)
    if (of[i] != bits(want, low + 32 * i, width - 32 * i < 32 ? width - 32 * i : 32)) return false;
  return true;
}

template <class Wide>
static void put_wide(std::string& to, const Wide& from, int low, int width) {
  for (int i = 0; i < width; ++i) to[to.size() - 1 - low - i] = '0' + (from[i / 32] >> i % 32 & 1);
}

static void put(std::string& to, std::uint64_t from, int low, int width) {
  for (int i = 0; i < width; ++i) to[to.size() - 1 - low - i] = '0' + (from >> i & 1);
}

#include "ports.h"  // drive, fits, show, mutate, STATES, state

struct Cycle {
  bool fresh;
  Words in, want;
};

static Words number(const char* text, std::size_t length, int width) {
  Words out(width / 32 + 2);
  for (std::size_t i = 0; i < length; ++i) {
    const char c = text[length - 1 - i];
    const std::uint32_t digit = c <= '9' ? c - '0' : c - 'a' + 10;
    if (i / 8 < out.size()) out[i / 8] |= digit << 4 * (i % 8);
  }
  return out;
}

static std::vector<Cycle> read_trace(const char* name) {
  std::vector<Cycle> cycles;
  std::FILE* file = std::fopen(name, "r");
  if (!file) return cycles;
  char* line = nullptr;
  std::size_t room = 0;
  while (getline(&line, &room, file) > 0) {
    const char* in = line + 2;
    const std::size_t in_length = std::strcspn(in, " \n");
    const char* want = in + in_length + 1;
    const std::size_t want_length = std::strcspn(want, " \n");
    cycles.push_back({line[0] == '1', number(in, in_length, IN_BITS), number(want, want_length, OUT_BITS)});
  }
  std::free(line);
  std::fclose(file);
  return cycles;
}

using Steps = std::map<std::tuple<int, bool, std::uint64_t, std::uint64_t>, long>;

// First cycle that differs, or -1. all: run on after it. points: file of the coverage, whose counts end with the model.
static long run(const std::vector<Cycle>& cycles, std::uint64_t mutant, bool all, const char* points, Steps& steps) {
  VerilatedContext context;
  context.randReset(points ? 0 : 2);    // a register before its reset has any value and covers nothing
  context.randSeed(1);
  const auto top = std::make_unique<VDut>(&context);
  std::uint64_t before[STATES + 1] = {};
  bool known = false, reset = false;
  long cycle = 0, first = -1;
  mutate(*top, mutant);
  top->clk = 0;
  for (const Cycle& c : cycles) {
    drive(*top, c.in);
    top->eval();
    if (!c.fresh && first < 0 && !fits(*top, c.want)) {
      first = cycle;
      if (!all) break;
    }
    for (int i = 0; i < STATES; ++i) {
      const std::uint64_t now = state(*top, i);
      if (known && !c.fresh) ++steps[{i, reset, before[i], now}];
      before[i] = now;
    }
    known = true;
    reset = top->reset;
    top->clk = 1;
    top->eval();
    top->clk = 0;
#if VM_COVERAGE
    if (!cycle && points) context.coveragep()->write(std::string(points) + ".first");
#endif
    ++cycle;
  }
  top->final();
#if VM_COVERAGE
  if (points) context.coveragep()->write(points);
#endif
  return first;
}

static int converse(std::uint64_t mutant, bool known) {
  VerilatedContext context;
  context.randReset(2);
  context.randSeed(1);
  const auto top = std::make_unique<VDut>(&context);
  mutate(*top, mutant);
  top->clk = 0;
  char* line = nullptr;
  std::size_t room = 0;
  std::string answer(OUT_BITS, '0');      // before the first edge, registers have no value
  while (getline(&line, &room, stdin) > 0) {
    if (line[0] == '1') {
      known = true;
      top->clk = 1;
      top->eval();
      top->clk = 0;
    }
    drive(*top, number(line + 2, std::strcspn(line + 2, "\n"), IN_BITS));
    top->eval();
    if (known) show(*top, answer);
    std::puts(answer.c_str());
    std::fflush(stdout);
  }
  std::free(line);
  top->final();
  return 0;
}

int main(int argc, char** argv) {
  if ((argc == 3 || argc == 4) && !std::strcmp(argv[1], "--drive")) return converse(std::atol(argv[2]), argc == 4);
  const char *points = nullptr, *states = nullptr;
  long first = 0, last = 0;
  bool all = true;
  if (argc < 2) return 2;
  for (int i = 2; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--points" && i + 1 < argc) points = argv[++i];
    else if (option == "--states" && i + 1 < argc) states = argv[++i];
    else if (option == "--mutants" && i + 2 < argc) {
      first = std::atol(argv[++i]);
      last = std::atol(argv[++i]);
      all = false;
    } else return 2;
  }
#if !VM_COVERAGE
  if (points) return 2;
#endif
  const std::vector<Cycle> cycles = read_trace(argv[1]);
  if (cycles.empty()) return 3;
  Steps steps;
  for (long mutant = first; mutant <= last; ++mutant) {
    std::printf("%ld %ld\n", mutant, run(cycles, mutant, all, points, steps));
    std::fflush(stdout);
  }
  if (states) {
    std::FILE* file = std::fopen(states, "w");
    if (!file) return 4;
    for (const auto& [key, times] : steps)
      std::fprintf(file, "%d %d %llu %llu %ld\n", std::get<0>(key), std::get<1>(key),
                   static_cast<unsigned long long>(std::get<2>(key)),
                   static_cast<unsigned long long>(std::get<3>(key)), times);
    if (std::fclose(file)) return 4;
  }
  return 0;
}
