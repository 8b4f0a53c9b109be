// The chip's Verilog (Bench, in Verilator) and a circuit (ngspice as a shared library) in lock-step, in one process.
//
// ngspice's transient runs and calls back. Its time never passes a corner of what drives the circuit: a step is cut there,
// and it is a breakpoint, at which ngspice lowers its order. A corner where nothing turns is none.
// At the rising edge of the clock the comparators' outputs go to the chip, the chip's registers are clocked, and its pins
// become ramps of the EXTERNAL sources. A cycle in which no switch of the circuit is closed and no comparator decides has
// no time of the circuit. At the end of the frame the process ends from within the transient.
//
// A circuit may have parts, which share nothing but the chip: each is a process with a chip of its own, and at a clock edge
// every chip gets the answers of all. Names of files below end with .0, .1, .. of each part.
//
//   +parts=N       of the circuit
//   +deck=FILE     the netlist; its last line is .end
//   +drive=FILE    head: period edge step stop high (s): clk is high for so long; the comparators' outputs, of each lane in
//                  order, separated by commas, "-" of a lane without a circuit in this part
//                  then lines "source bit low high half rise fall": volts at 0 and 1 of a bit of `controls`, delays (s) of
//                  its edges; with half = 1 it is high while clk is low
//                  the bit of vlight0 .. vlight3, the light of each tap, is -1
//   +cycles=FILE   what was asked and answered in each cycle of the circuit, as text
//   +points=FILE   every time point, binary doubles: time and the saved vectors, whose names are the first line
//   +lockstep=FILE what it took, as JSON
//   +uic=1         no operating point: the transient begins with the netlist's .ic
//   +max_cycles=N  exit status 4 where the frame has not ended by then; 5 where ngspice gives up, 6 where another part has
// The others are the bench's (imaging/simulate/bench.sv).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include "VBench.h"
#include "verilated.h"
#include <ngspice/sharedspice.h>

namespace {
constexpr double EXACT = 1e-16;  // s within which two times are one
constexpr unsigned LIGHT = ~0u;  // "bit" of a source that is light

struct Source {
  std::string name;
  unsigned bit;
  double low, high;
  bool half;
  double rise, fall;
  double from, to, start;
};

VerilatedContext* context;
VBench* top;
std::vector<Source> sources;
std::unordered_map<std::string, Source*> by_name;
double period, edge, step, stop, high, threshold = 0.9;
std::vector<double> events;      // of a cycle: its clock edge, clk's fall and the end of light, s
std::set<double> corners;        // s, of what turns: begins and ends of ramps that are to come
std::uint64_t ticks = 0, analog = 0, period_number = 0, limit = 1000000000, rejected = 0, accepted = 0;
std::size_t event = 0;           // the next one
bool begun = false;              // a ramp, right now
bool started = false, was_busy = false, pixels = false;
std::uint64_t pending = 0;       // cycles of integration whose charge the circuit has not got
unsigned shining = 0;            // the tap that they are of
Source* light[4] = {};           // of each tap, 1 at the photocurrents' own strength
std::vector<std::string> nodes;
std::vector<int> answer_at;      // of each lane, the vector
std::vector<double> point;
std::string wanted, part = ".0";  // nodes of the answers; end of this part's files
int to_hub = -1, from_hub = -1;
std::FILE *points = nullptr, *cycles = nullptr;
std::chrono::steady_clock::time_point began;
std::clock_t worked;

std::string argument(const char* name) {
  const char* match = context->commandArgsPlusMatch(name);
  return match && *match ? match + std::strlen(name) + 1 : "";
}

std::string own(const char* name) { return argument(name) + part; }

template <class T> bool bit_of(const T& signal, unsigned at) {
  return reinterpret_cast<const std::uint8_t*>(&signal)[at / 8] >> at % 8 & 1;
}

#define AFE(name) (top->rootp->Bench__DOT__afe__DOT__##name)

double value(const Source& s, double time) {
  if (time <= s.start) return s.from;
  return time >= s.start + edge ? s.to : s.from + (s.to - s.from) * (time - s.start) / edge;
}

void turn(Source& s, bool on, double time) {
  const double to = on ? s.high : s.low;
  if (to == s.to) return;
  s.from = s.to;
  s.to = to;
  s.start = time + (on ? s.rise : s.fall);
  for (const double at : {s.start, s.start + edge})
    if (at <= time + EXACT) begun = true;
    else if (corners.insert(at).second) ngSpice_SetBkpt(at);
}

void tick() {
  top->clk = 0;
  top->eval();
  top->clk = 1;
  top->eval();
  if (++ticks == 4) top->reset = 0;
  if (ticks > limit) {
    std::fprintf(stderr, "no frame end within %llu cycles\n", static_cast<unsigned long long>(limit));
    std::_Exit(4);
  }
}

bool busy() { return AFE(running); }

// A cycle without time of the circuit: nothing switches. Of an integration there is one cycle, after its end, in which
// light `2 * cycles` times as strong shines for half the period: the same charge.
bool quiet() {
  if (AFE(converting) || (pixels && AFE(phases))) return false;
  return !pixels || AFE(integrating) || pending == 0;
}

// The frame is over: the rest of the host's script needs no circuit.
[[noreturn]] void finish() {
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - began;
  const double processor = static_cast<double>(std::clock() - worked) / CLOCKS_PER_SEC;
  const auto of_frame = ticks;
  while (!top->done && !context->gotFinish()) tick();
  top->final();
  std::fclose(points);
  std::fclose(cycles);
  std::FILE* stats = std::fopen(own("lockstep=").c_str(), "w");
  if (!stats) std::_Exit(3);
  std::fprintf(stats,
               "{\"seconds\": %.6f, \"processor_seconds\": %.6f, \"cycles\": %llu, \"circuit_cycles\": %llu, \"accepted\": %llu, \"rejected\": %llu}\n",
               spent.count(), processor, static_cast<unsigned long long>(of_frame), static_cast<unsigned long long>(analog),
               static_cast<unsigned long long>(accepted), static_cast<unsigned long long>(rejected));
  std::fclose(stats);
  std::fflush(nullptr);
  std::_Exit(top->done ? 0 : 4);
}

// The answers of all parts, given this one's; none comes where one of them has ended.
std::uint32_t of_all(std::uint32_t answers) {
  if (to_hub < 0) return answers;
  std::uint32_t all = 0;
  if (write(to_hub, &answers, sizeof answers) != sizeof answers || read(from_hub, &all, sizeof all) != sizeof all) std::_Exit(6);
  return all;
}

// Each part in a process; returns in those, and ends here with the worst of their statuses.
void divide(unsigned count) {
  std::signal(SIGPIPE, SIG_IGN);
  std::vector<int> from, to;
  std::vector<pid_t> children;
  for (unsigned k = 0; k < count; ++k) {
    int up[2], down[2];
    if (pipe(up) || pipe(down)) std::_Exit(3);
    const pid_t child = fork();
    if (child < 0) std::_Exit(3);
    if (child == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      for (const int fd : from) close(fd);
      for (const int fd : to) close(fd);
      close(up[0]);
      close(down[1]);
      to_hub = up[1];
      from_hub = down[0];
      part = "." + std::to_string(k);
      return;
    }
    close(up[1]);
    close(down[0]);
    from.push_back(up[0]);
    to.push_back(down[1]);
    children.push_back(child);
  }
  for (bool running = true; running;) {
    std::uint32_t all = 0;
    for (const int fd : from) {
      std::uint32_t one = 0;
      running &= read(fd, &one, sizeof one) == sizeof one;
      all |= one;
    }
    for (const int fd : to)
      if (running) running = write(fd, &all, sizeof all) == sizeof all;
  }
  for (const int fd : to) close(fd);
  int worst = 0;
  for (const pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
    if (code && (!worst || worst == 6)) worst = code;
  }
  std::_Exit(worst);
}

double volts_of(unsigned lane) { return answer_at[lane] < 0 ? 0.0 : point[answer_at[lane]]; }

void record() {
  const std::uint32_t place = AFE(place);
  std::fprintf(cycles, "%llu %llu %u", static_cast<unsigned long long>(analog), static_cast<unsigned long long>(ticks), place);
  const auto* asked = reinterpret_cast<const std::uint8_t*>(&AFE(question));
  const auto* kept = reinterpret_cast<const double*>(&AFE(held));
  for (unsigned l = 0; l < answer_at.size(); ++l)
    std::fprintf(cycles, " %d %u %d %d %.9g %.9g", bit_of(AFE(deciding), l), asked[l], bit_of(AFE(answers), l),
                 bit_of(AFE(expected), l), kept[l], volts_of(l));
  std::fputc('\n', cycles);
}

// The rising edge at which a cycle of the circuit begins: the answers of the cycle before go to the chip.
void clock_edge(double time) {
  if (started) {
    std::uint32_t answers = 0;
    for (unsigned l = 0; l < answer_at.size(); ++l)
      answers |= static_cast<std::uint32_t>(bit_of(AFE(deciding), l) && volts_of(l) > threshold) << l;
    AFE(answers) = of_all(answers);
    top->clk = 0;
    top->eval();
    record();
    ++analog;
  }
  started = true;
  do {
    tick();
    if (pixels && AFE(integrating)) {
      ++pending;
      shining = AFE(tap);
    }
    if (was_busy && !busy() && quiet()) finish();
    was_busy |= busy();
  } while (quiet());
  if (pending && !AFE(integrating)) {
    light[shining]->high = 2.0 * static_cast<double>(pending);
    turn(*light[shining], true, time);
    pending = 0;
  }
  for (Source& s : sources) if (s.bit != LIGHT) turn(s, !s.half && bit_of(AFE(controls), s.bit), time);
}

double due() { return static_cast<double>(period_number) * period + events[event]; }

bool nothing_at(double moment) {
  const auto turns = [&](const Source& s) {
    if (moment == 0.5 * period && s.bit == LIGHT && s.to != s.low) return true;
    return moment == high && s.half && bit_of(AFE(controls), s.bit);
  };
  return std::none_of(sources.begin(), sources.end(), turns);
}

void happen() {
  const double now = due();
  if (event == 0) clock_edge(now);
  else if (events[event] == high)
    for (Source& s : sources)
      if (s.half) turn(s, bit_of(AFE(controls), s.bit), now);
  if (events[event] == 0.5 * period && pixels)
    for (Source* s : light) turn(*s, false, now);
  do
    if (++event == events.size()) {
      event = 0;
      ++period_number;
    }
  while (event && nothing_at(events[event]));
  ngSpice_SetBkpt(due());
}

int sync(double time, double* delta, double, int redo, int, int location, void*) {
  if (location) {
    redo ? ++rejected : ++accepted;
    return 0;
  }
  begun = false;
  while (time >= due() - EXACT) happen();
  while (!corners.empty() && time >= *corners.begin() - EXACT) corners.erase(corners.begin());
  const double next = corners.empty() ? due() : std::min(due(), *corners.begin());
  if (begun) *delta = std::min(*delta, 0.1 * edge);  // as after a breakpoint
  if (time + *delta > next) *delta = next - time;
  return 0;
}

int volts(double* result, double time, char* name, int, void*) {
  const auto found = by_name.find(name);
  if (found == by_name.end()) {
    std::fprintf(stderr, "%s: is no source of the drive\n", name);
    std::_Exit(3);
  }
  *result = value(*found->second, time);
  return 0;
}

int data(pvecvaluesall all, int, int, void*) {
  for (int i = 0; i < all->veccount; ++i) point[i] = all->vecsa[i]->creal;
  std::fwrite(point.data(), sizeof(double), point.size(), points);
  return 0;
}

int first_data(pvecinfoall all, int, void*) {
  point.assign(all->veccount, 0.0);
  for (int i = 0; i < all->veccount; ++i) {
    nodes.push_back(all->vecs[i]->vecname);
    std::fprintf(points, "%s%c", all->vecs[i]->vecname, i + 1 < all->veccount ? ' ' : '\n');
  }
  for (std::size_t from = 0; from < wanted.size();) {
    const std::size_t to = std::min(wanted.find(',', from), wanted.size());
    const std::string name = wanted.substr(from, to - from);
    const auto found = std::find(nodes.begin(), nodes.end(), name);
    if (found == nodes.end() && name != "-") std::_Exit(3);
    answer_at.push_back(name == "-" ? -1 : static_cast<int>(found - nodes.begin()));
    from = to + 1;
  }
  return 0;
}

int said(char* text, int, void*) {
  std::fprintf(stderr, "%s\n", text);
  return 0;
}

int ended(int, NG_BOOL, NG_BOOL, int, void*) { std::_Exit(5); }

bool read_drive(const std::string& name) {
  std::FILE* file = std::fopen(name.c_str(), "r");
  char text[256];
  if (!file || std::fscanf(file, "%lf %lf %lf %lf %lf %255s", &period, &edge, &step, &stop, &high, text) != 6) return false;
  wanted = text;
  int bit, half;
  double zero, one, rise, fall;
  while (std::fscanf(file, "%255s %d %lf %lf %d %lf %lf", text, &bit, &zero, &one, &half, &rise, &fall) == 7) {
    sources.push_back({text, static_cast<unsigned>(bit), zero, one, half != 0, rise, fall, zero, zero, -1.0});
  }
  std::fclose(file);
  for (Source& s : sources) by_name[s.name] = &s;
  for (unsigned t = 0; t < 4; ++t)
    if (const auto found = by_name.find("vlight" + std::to_string(t)); found != by_name.end()) light[t] = found->second;
  pixels = light[0] && light[1] && light[2] && light[3];
  const std::set<double> at = {0.0, high, 0.5 * period};
  events.assign(at.begin(), at.end());
  return true;
}
}  // namespace

int main(int argc, char** argv) {
  context = new VerilatedContext;
  context->commandArgs(argc, argv);
  if (const int count = std::atoi(argument("parts=").c_str()); count > 1) {
    divide(static_cast<unsigned>(count));
    if (part != ".0") {  // what the bench writes is the same in all
      std::vector<std::string> kept(argv, argv + argc);
      std::vector<const char*> given;
      for (std::string& one : kept) {
        for (const char* name : {"+stream=", "+miso=", "+activity="})
          if (one.rfind(name, 0) == 0) one = std::string(name) + "/dev/null";
        given.push_back(one.c_str());
      }
      context->commandArgs(argc, given.data());
    }
  }
  top = new VBench{context};
  if (const std::string text = argument("max_cycles="); !text.empty()) limit = std::strtoull(text.c_str(), nullptr, 10);
  points = std::fopen(own("points=").c_str(), "wb");
  cycles = std::fopen(own("cycles=").c_str(), "w");
  if (!points || !cycles || !read_drive(own("drive="))) {
    std::fprintf(stderr, "+points, +cycles or +drive: cannot be opened\n");
    return 3;
  }
  std::setvbuf(cycles, nullptr, _IOLBF, 1 << 12);  // who waits reads how far it is
  ngSpice_Init(said, nullptr, ended, data, first_data, nullptr, nullptr);
  ngSpice_Init_Sync(volts, nullptr, sync, nullptr, nullptr);
  char alone[] = "set num_threads=1";  // more wait for each other longer than they work
  ngSpice_Command(alone);
  char simple[] = "optran 1 1 1 0 0 0";  // an operating point by a transient would go through `sync` and move the chip
  ngSpice_Command(simple);
  if (ngSpice_Command(const_cast<char*>(("source " + own("deck=")).c_str()))) return 5;
  top->reset = 1;
  top->eval();
  while (!AFE(running)) tick();  // the host's configuration
  char command[128];
  const char* from = argument("uic=").empty() ? "" : " uic";
  std::snprintf(command, sizeof command, "tran %g %g 0 %g%s", step, stop, step, from);
  began = std::chrono::steady_clock::now();
  worked = std::clock();
  ngSpice_Command(command);
  std::fprintf(stderr, "the transient ended before the frame, in cycle %llu of the circuit\n",
               static_cast<unsigned long long>(analog));
  return 5;
}
