// Bit-parallel fault simulation: each bit of a net's word is the chip with another fault.
//
// A gate reads a, b, s and drives out; flip-flops follow the gates, and their word in `values` is that of the edge
// before. site: the gate's place in `stuck`, or -1: two masks, at 0 and at 1, for each of its pins a, b, s, out.

#include <stdint.h>
#include <string.h>

typedef uint64_t word __attribute__((vector_size(64), aligned(8)));

enum { AND, NAND, OR, NOR, XOR, XNOR, MUX, NOT, BUF, FF };

typedef struct { int32_t kind, a, b, s, out, site; } gate;

static word evaluate(int kind, word a, word b, word s) {
  switch (kind) {
    case AND: return a & b;
    case NAND: return ~(a & b);
    case OR: return a | b;
    case NOR: return ~(a | b);
    case XOR: return a ^ b;
    case XNOR: return ~(a ^ b);
    case MUX: return (a & ~s) | (b & s);
    case NOT: return ~a;
    default: return a;
  }
}

#define STUCK(value, site, pin) (((value) & ~stuck[8 * (site) + 2 * (pin)]) | stuck[8 * (site) + 2 * (pin) + 1])

// good: the outputs without a fault, a byte a bit; they are written in the cycles before compare_from.
// found: which bits have differed from them since. next: room for the flip-flops' data.
void simulate(const gate *gates, int64_t count, int64_t total, word *values, const word *stuck, const uint8_t *inputs,
              int64_t cycles, const int32_t *in, int64_t n_in, const int32_t *out, int64_t n_out, uint8_t *good,
              int64_t compare_from, word *next, word *found) {
  const word none = {0};
  for (int64_t cycle = 0; cycle < cycles; cycle++) {
    for (int64_t i = 0; i < n_in; i++) values[in[i]] = inputs[cycle * n_in + i] ? ~none : none;
    for (int64_t i = 0; i < total; i++) {
      const gate *g = &gates[i];
      word a = values[g->a], b = values[g->b], s = values[g->s], y;
      if (g->site < 0) y = evaluate(g->kind, a, b, s);
      else y = STUCK(evaluate(g->kind, STUCK(a, g->site, 0), STUCK(b, g->site, 1), STUCK(s, g->site, 2)), g->site, 3);
      if (i < count) values[g->out] = y;
      else next[i - count] = y;
    }
    word all = ~none;
    for (int64_t i = 0; i < n_out; i++) {
      uint8_t *wanted = &good[cycle * n_out + i];
      if (cycle < compare_from) *wanted = values[out[i]][0] & 1;
      else *found |= *wanted ? ~values[out[i]] : values[out[i]];
    }
    if (memcmp(found, &all, sizeof all) == 0) return;
    for (int64_t i = count; i < total; i++) values[gates[i].out] = next[i - count];
  }
}
