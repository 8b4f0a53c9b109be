// Sessions at the pins of the chip alone: `program SESSIONS SEEN [+metastable]`.
//
// SESSIONS: a line each, 'seed scene' and operations:
//   R n     reset for n cycles, then 8 more      W n     n cycles
//   L p     the link is ready in p of 16 cycles  E n     until the chip is idle, at most n cycles
//   T half bits hex   an SPI transfer, cut after so many bits; half: cycles of half an SPI clock
// Every session begins with a new chip, whose registers have random values (Verilator's --x-initial unique).
//
// Writes to stdout, a session a line: 'new cycles', a token for each operation, and one for each byte of a transfer:
// 'o cycle stalls busy taken miso', and 'b' with (busy, link_val, taken) 2, 3, 4 and 5 cycles after the eighth rising edge
// of sclk and 2 and 3 cycles after its falling edge; then 's' and the bytes taken from the link, 3 hexadecimal digits
// each, the first of them frame_sync.
// new: points that no session before reached. SEEN: file of all points reached. A point is a count of Verilator's
// coverage, in classes that grow by powers of two, or two successive values of the register `state`.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "VAspChip.h"
#include "VAspChip___024root.h"
#include "VAspChip__Syms.h"
#include "verilated.h"

constexpr std::size_t COUNTS = sizeof(VAspChip__Syms::__Vcoverage) / sizeof(VAspChip__Syms::__Vcoverage[0]);
constexpr std::size_t STEPS = 1 << 16;

static std::vector<unsigned char> seen(COUNTS + STEPS);

template <class T>
static std::uint64_t word(const T& value) { return value; }

static std::uint32_t mixed(std::uint32_t value) {   // as scene.py
  value = (value ^ value >> 16) * 0x7feb352du;
  value = (value ^ value >> 15) * 0x846ca68bu;
  return value ^ value >> 16;
}

class Session {
 public:
  explicit Session(std::uint32_t seed, std::uint32_t scene, int argc, char** argv) : scene(scene), random(seed | 1) {
    context.commandArgs(argc, argv);
    context.randReset(2);
    context.randSeed(static_cast<int>(mixed(seed) >> 1) | 1);
    chip = std::make_unique<VAspChip>(&context);
    chip->csn = 1;
    chip->sclk = chip->mosi = chip->reset = 0;
    chip->comparator = 0;
  }

  void tick() {
    random = random * 6364136223846793005u + 1442695040888963407u;
    chip->link_rdy = static_cast<int>(random >> 60) < ready;
    chip->clk = 0;
    chip->eval();
    std::uint32_t answers = 0;
    for (int lane = 0; lane < LANES; ++lane)
      answers |= std::uint32_t{held[lane] >= static_cast<int>(chip->dac >> 8 * lane & 0xff)} << lane;
    chip->comparator = answers;
    chip->eval();
    if (chip->link_val && chip->link_rdy) taken.push_back(chip->link_data | chip->frame_sync << 8);
    stalls += chip->link_val && !chip->link_rdy;
    if (chip->hold) sample();
    chip->clk = 1;
    chip->eval();
    ++cycle;
    probe();
    const std::uint32_t now = word(chip->rootp->STATE);
    if (now != state) {
      unsigned char& step = steps[(mixed(state) ^ now * 0x9e3779b1u) % STEPS];
      step = 1;
      state = now;
    }
  }

  void wait(long cycles) {
    while (cycles-- > 0) tick();
  }

  std::string run(const std::string& operation, std::istream& in) {
    std::string miso = "-";
    bytes.clear();
    if (operation == "T") {
      miso = transfer(in);
    } else {
      long count = 0;
      in >> count;
      if (operation == "R") {
        chip->reset = 1;
        wait(count);
        chip->reset = 0;
        wait(8);
      } else if (operation == "L") {
        ready = count;
      } else if (operation == "W") {
        wait(count);
      } else {
        for (long i = 0; i < count && (i < 12 || chip->busy || chip->link_val); ++i) tick();
      }
    }
    std::ostringstream out;
    out << " o " << cycle << ' ' << stalls << ' ' << int(chip->busy) << ' ' << taken.size() << ' ' << miso << bytes;
    return out.str();
  }

  std::string transfer(std::istream& in) {
    long half = 4;
    std::size_t bits = 0;
    std::string hex, miso;
    in >> half >> bits >> hex;
    chip->csn = 0;
    wait(half);
    for (std::size_t i = 0; i < bits && i < 4 * hex.size(); ++i) {
      const unsigned digit = hex[i / 4] <= '9' ? hex[i / 4] - '0' : hex[i / 4] - 'a' + 10;
      chip->mosi = digit >> (3 - i % 4) & 1;
      wait(half);
      miso += chip->miso ? '1' : '0';
      chip->sclk = 1;
      if (i % 8 == 7) rise = cycle, bytes += " b";
      wait(half);
      chip->sclk = 0;
      if (i % 8 == 7) fall = cycle;
    }
    wait(half);
    chip->csn = 1;
    wait(2 * half);
    return miso.empty() ? "-" : miso;
  }

  void finish(long fresh, std::string& line) {
    static const char digits[] = "0123456789abcdef";
    line = std::to_string(fresh) + ' ' + std::to_string(cycle) + line + " s ";
    for (const int byte : taken)
      for (int i = 8; i >= 0; i -= 4) line += digits[byte >> i & 0xf];
    chip->final();
  }

  long reached() {   // points that no session before reached
    long fresh = 0;
    const auto& counts = chip->rootp->vlSymsp->__Vcoverage;
    for (std::size_t i = 0; i < COUNTS; ++i) {
      const std::uint32_t count = counts[i];
      const int size = count ? 32 - __builtin_clz(count) : 0;      // 1, 2, 3: alone; 4 to 15, 16 to 127, 128 and more
      const unsigned char bit = !count ? 0 : count < 4 ? 1 << (count - 1) : size < 5 ? 8 : size < 8 ? 16 : 32;
      fresh += (seen[i] | bit) != seen[i];
      seen[i] |= bit;
    }
    for (std::size_t i = 0; i < STEPS; ++i) {
      fresh += steps[i] && !seen[COUNTS + i];
      seen[COUNTS + i] |= steps[i];
    }
    return fresh;
  }

 private:
  void probe() {
    if (rise >= 0 && cycle - rise >= 2 && cycle - rise <= 5) observe();
    if (fall >= 0 && cycle - fall >= 2 && cycle - fall <= 3) observe();
  }

  void observe() {
    bytes += ' ' + std::to_string(chip->busy) + ' ' + std::to_string(chip->link_val) + ' ' + std::to_string(taken.size());
  }

  void sample() {
    for (int lane = 0; lane < LANES; ++lane) {
      if (!(chip->en >> lane & 1)) continue;
      const std::uint32_t column = TILE_COLS * (LANES * chip->group + lane) + chip->k;
      const std::uint32_t hash = mixed(scene + chip->row * 0x9e3779b1u + column * 0x85ebca6bu + chip->sub * 0xc2b2ae35u);
      const int balance = static_cast<int>(chip->balance ^ 0x200) - 0x200;
      if (chip->unsigned_)
        held[lane] = static_cast<int>((hash >> 8) % 272) - 8;
      else
        held[lane] = 128 + (balance >> 4) + static_cast<int>(hash & 1 ? (hash >> 8) % 17 - 8 : (hash >> 8) % 289 - 144);
    }
  }

  VerilatedContext context;
  std::unique_ptr<VAspChip> chip;
  std::uint32_t scene, state = 0;
  std::uint64_t random;
  int ready = 16, held[LANES] = {};
  long cycle = 0, stalls = 0, rise = -1, fall = -1;
  std::vector<int> taken;
  std::string bytes;
  std::vector<unsigned char> steps = std::vector<unsigned char>(STEPS);
};

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  std::ifstream sessions(argv[1]);
  if (!sessions) return 3;
  if (std::ifstream before(argv[2], std::ios::binary); before)
    before.read(reinterpret_cast<char*>(seen.data()), static_cast<std::streamsize>(seen.size()));
  for (std::string line, operation; std::getline(sessions, line);) {
    std::istringstream in(line);
    std::uint32_t seed = 0, scene = 0;
    in >> seed >> scene;
    Session session(seed, scene, argc, argv);
    std::string out;
    while (in >> operation) out += session.run(operation, in);
    session.finish(session.reached(), out);
    std::puts(out.c_str());
  }
  std::ofstream after(argv[2], std::ios::binary);
  after.write(reinterpret_cast<const char*>(seen.data()), static_cast<std::streamsize>(seen.size()));
  return after.good() ? 0 : 4;
}
