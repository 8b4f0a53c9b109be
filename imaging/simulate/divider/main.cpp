// A source and a sink at the streams of one divider: `program REQUESTS RESPONSES NOISE_FLOOR SEED`.
//
// REQUESTS: DivReq messages as little-endian uint32; RESPONSES: DivResp messages as uint64, in the order they came.
// SEED 0: both sides are always willing; else each is willing in a random half of the cycles.
// Writes a line of JSON: cycles, seconds, least and most latency and interval.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "VQuadDivider.h"
#include "verilated.h"

struct Willing {
  std::uint64_t state;
  unsigned operator()() {   // two bits of xorshift64
    if (!state) return 3;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return state >> 40 & 3;
  }
};

struct Range {
  long least = -1, most = -1;
  void add(long value) {
    least = least < 0 ? value : std::min(least, value);
    most = std::max(most, value);
  }
};

static std::vector<std::uint32_t> read_requests(const char* name) {
  std::vector<std::uint32_t> requests;
  std::FILE* file = std::fopen(name, "rb");
  if (!file) return requests;
  std::fseek(file, 0, SEEK_END);
  requests.resize(std::ftell(file) / sizeof requests[0]);
  std::rewind(file);
  requests.resize(std::fread(requests.data(), sizeof requests[0], requests.size(), file));
  std::fclose(file);
  return requests;
}

static bool write_responses(const char* name, const std::vector<std::uint64_t>& responses) {
  std::FILE* file = std::fopen(name, "wb");
  if (!file) return false;
  const bool whole = std::fwrite(responses.data(), sizeof responses[0], responses.size(), file) == responses.size();
  return !std::fclose(file) && whole;
}

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const std::vector<std::uint32_t> requests = read_requests(argv[1]);
  Willing willing{std::strtoull(argv[4], nullptr, 10)};
  VerilatedContext context;
  VQuadDivider top{&context};
  auto &recv_val = top.recv___05Fval, &recv_rdy = top.recv___05Frdy;      // Verilator's way to write recv__val
  auto &send_val = top.send___05Fval, &send_rdy = top.send___05Frdy;

  const auto tick = [&top] {
    top.clk = 1;
    top.eval();
    top.clk = 0;
  };
  top.clk = recv_val = send_rdy = 0;
  top.noise_floor = std::atoi(argv[3]);
  top.reset = 1;
  top.eval();
  tick();
  tick();
  top.reset = 0;

  std::vector<std::uint64_t> responses;
  std::vector<long> asked;
  responses.reserve(requests.size());
  asked.reserve(requests.size());
  Range latency, interval;
  long cycle = 0, last = -1;
  const long limit = 200 * static_cast<long>(requests.size()) + 1000;
  const auto start = std::chrono::steady_clock::now();
  for (; responses.size() < requests.size() && cycle < limit; ++cycle) {
    const unsigned sides = willing();
    const bool offered = asked.size() < requests.size() && (recv_val || sides & 1);    // an offer stays
    recv_val = offered;
    if (offered) top.recv___05Fmsg = requests[asked.size()];
    send_rdy = sides >> 1;
    top.eval();
    const bool taken = recv_val && recv_rdy;
    if (taken) asked.push_back(cycle);
    if (send_val && send_rdy) {
      if (asked.size() <= responses.size()) return 3;   // a response that nobody asked for
      latency.add(cycle - asked[responses.size()]);
      if (last >= 0) interval.add(cycle - last);
      last = cycle;
      responses.push_back(top.send___05Fmsg);
    }
    tick();
    if (taken) recv_val = 0;
  }
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  top.final();
  if (!write_responses(argv[2], responses)) return 4;
  std::printf("{\"cycles\": %ld, \"seconds\": %.9f, \"latency\": [%ld, %ld], \"interval\": [%ld, %ld]}\n", cycle,
              spent.count(), latency.least, latency.most, interval.least, interval.most);
  return 0;
}
