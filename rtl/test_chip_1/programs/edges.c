// Decodes a frame of the ASP chip in edge mode (docs/stream.md), counts its edges by cell, and decides on a wake-up.

typedef unsigned char u8;
typedef unsigned u32;

struct job { // at 0x800; the host writes the first five words
  const u8 *stream;
  u8 *counts;        // of the cells, row by row; 0 before
  u32 shift;         // a cell is 2^shift x 2^shift tiles
  u32 least_edges;   // of a busy cell
  u32 least_cells;   // busy cells that wake the host
  u32 status;        // 0: right, 1: of another kind of frame, 2: damaged
  u32 edges;
  u32 busy;          // cells
};

extern struct job job;

static const u8 *next; // of the payload
static u32 hold, held; // bits ahead of it, from the top
static u32 row, row_end, tile_row, tile_rows, row_in_tile, k, tile_cols, left; // of the next sample's column
static u32 cells, first_tile, past_tile, past, whole_tiles, cut_cols;
static u8 *line;

static void refill(void)
{
  for (; held <= 24; held += 8)
    hold |= *next++ << (24 - held);
}

static u32 take(u32 number) // of bits, 1..24
{
  u32 bits = hold >> (32 - number);
  hold <<= number;
  held -= number;
  return bits;
}

static void start_column(void) // the tiles of column k of this row
{
  past = whole_tiles + (k < cut_cols);
  past = past < past_tile ? past : past_tile;
  left = past > first_tile ? past - first_tile : 0;
}

static void next_tile_row(void)
{
  row_in_tile = 0;
  if (!(++tile_row & ((1 << job.shift) - 1)))
    line += cells;
}

static void pass(u32 samples, int within_row)
{
  while (samples >= left && row < row_end) {
    samples -= left;
    if (++k < tile_cols) {
      start_column();
      continue;
    }
    row++;
    if (++row_in_tile == tile_rows)
      next_tile_row();
    k = 0;
    start_column();
    if (within_row)
      return;
  }
  left -= samples;
}

static void count(void)
{
  line[(past - left) >> job.shift]++;
  job.edges++;
}

static u32 value(u32 *r2) // of docs/stream.md
{
  u32 order = (*r2 >> 1) + 1, zeros = 0;
  refill();
  while (zeros < 9 && !(hold >> (31 - zeros)))
    zeros++;
  if (!zeros) {
    take(1);
    *r2 -= *r2 > 0;
    return take(order);
  }
  take(zeros);
  *r2 += zeros > 1 && *r2 < 7;
  return take(order + zeros);
}

static const unsigned short table[16] = { // CRC-16/IBM-3740 of four bits
  0x0000, 0x1021, 0x2042, 0x3063, 0x4084, 0x50a5, 0x60c6, 0x70e7,
  0x8108, 0x9129, 0xa14a, 0xb16b, 0xc18c, 0xd1ad, 0xe1ce, 0xf1ef,
};

static u32 crc16(const u8 *from, const u8 *to)
{
  u32 crc = 0xffff;
  for (; from < to; from++) {
    crc = (crc << 4 & 0xffff) ^ table[crc >> 12 ^ *from >> 4];
    crc = (crc << 4 & 0xffff) ^ table[crc >> 12 ^ (*from & 15)];
  }
  return crc;
}

static u32 segment(u32 base, u32 whole_bytes) // returns whether it fits its mark
{
  const u8 *begin = next;
  u32 mark = row, r2 = 2, dense = base < 4;
  int order = dense ? 8 : 16, credit = 128, full;
  hold = held = 0;
  do {
    u32 q = (u32)order >> 2, before, zeros = 0, x;
    refill();
    before = 8 * (next - begin) - held;
    full = before >> 3 >= whole_bytes;
    if (credit >> 2 < (int)q + 16) {
      if (take(8))
        count();
      credit += 1;
      pass(1, 0);
    } else if (q && !take(1)) {
      pass(1 << (q - 1), full);
      order += dense ? 1 : 4;
      credit += 29;
    } else {
      if (q > 1)
        zeros = take(q - 1);
      x = value(&r2);
      pass(zeros, 0);
      if (row >= row_end)
        return 0;
      if (q || x)
        count(), order -= dense ? 1 : 8;
      else
        order += 1;
      pass(1, 0);
      credit += 33 - 4 * (int)(8 * (next - begin) - held - before);
    }
    order = order > 48 ? 48 : order < (dense ? 0 : 4) ? (dense ? 0 : 4) : order;
    credit = credit > 255 ? 255 : credit;
    full = (8 * (next - begin) - held) >> 3 >= whole_bytes;
  } while (row < row_end && !(full && k == 0 && left == past - first_tile));
  next -= held >> 3;
  mark ^= crc16(begin, next);
  next += 2;
  return mark == (u32)(next[-2] << 8 | next[-1]);
}

int main(void)
{
  const u8 *head = job.stream;
  u32 threshold = head[6], types = 0, busy = 0;
  next = head + 32;
  job.status = 1;
  job.edges = 0;
  tile_rows = head[8] >> 4;
  tile_cols = head[8] & 15;
  for (u32 n = 0; n < tile_rows; n++)
    types = types << tile_cols | ((1 << tile_cols) - 1);
  if (head[0] != 'T' || head[1] != 'L' || head[2] != 'B' || head[3] != 'T' || head[4] != 3 || head[5] & 0x3f
      || types != (u32)(head[17] << 16 | head[18] << 8 | head[19]))
    return 0; // edge mode without ternary, every row and type
  row_end = head[9] << 8 | head[10];
  first_tile = head[15];
  past_tile = head[16] + 1;
  whole_tiles = 0;
  for (cut_cols = head[11] << 8 | head[12]; cut_cols >= tile_cols; cut_cols -= tile_cols)
    whole_tiles++;
  cells = (whole_tiles + (cut_cols > 0) + (1 << job.shift) - 1) >> job.shift;
  line = job.counts;
  row = tile_row = k = 0;
  for (; tile_row < head[13]; next_tile_row())
    row += tile_rows;
  for (u32 n = 0, stop = 0; n <= head[14]; n++)
    if ((stop += tile_rows) < row_end && n == head[14])
      row_end = stop;
  row_in_tile = 0;
  start_column();
  job.status = 2;
  while (row < row_end)
    if (!segment(threshold ? threshold : 1, 64 * (head[5] >> 6)))
      return 0;
  job.status = 0;
  if (row_in_tile || tile_row & ((1 << job.shift) - 1))
    line += cells; // past the last
  for (const u8 *cell = job.counts; cell < line; cell++)
    busy += *cell >= job.least_edges;
  job.busy = busy;
  if (busy >= job.least_cells)
    __asm__ volatile("csrw 0x7c0, %0" : : "r"(busy)); // a word for the host: the pin wakes it
  return 0;
}
