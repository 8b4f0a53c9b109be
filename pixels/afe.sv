// The analog front end of a whole frame in real numbers: pixel values, trimmed difference amplifier, and for every
// lane sample-and-hold, DAC and comparator. The twin of models/afe, sample for sample; see README.md.
//
//   +samples=FILE     diode values of every pixel (models/afe/files.py, write_samples), one exposure after another
//   +taps=N           taps of each exposure, 1..4; without it the file is one exposure
//   +converter=FILE   gain and imperfections (write_converter)
/* verilator lint_off DECLFILENAME */      // the module is spelt as the chip's are
/* verilator lint_off UNUSEDPARAM */        // TILE_ROWS belongs to the geometry that every module is given
`default_nettype none
`ifndef BALANCE_BITS
`define BALANCE_BITS 10
`endif

`ifndef AFE
`define AFE Afe
`endif

module `AFE #(
    parameter int ROWS = 384, COLS = 384, LANES = 8, TILE_ROWS = 4, TILE_COLS = 6
) (
    input  wire                            clk,
    input  wire        [1:0]               mode,        // 0 edge, 1 image, 2 raw, 3 tof
    input  wire        [9:0]               row,
    input  wire        [7:0]               group,       // lane l is at tile column LANES * group + l
    input  wire        [2:0]               k,           // column in the tile
    input  wire        [1:0]               sub,         // raw: diode; tof: tap
    input  wire        [LANES-1:0]         en,
    input  wire signed [`BALANCE_BITS-1:0] balance,     // capacitor ratio 1 + balance / 512
    input  wire                            hold,        // the enabled lanes sample at the end of this cycle
    input  wire        [8*LANES-1:0]       dac,
    input  wire                            unsigned_,   // DAC range 0..255, else -128..127 in offset binary
    output wire        [LANES-1:0]         comparator
);
  localparam int FRAME = ROWS * COLS * 2;               // words of one tap
  localparam int TAPS = 4;                              // most of an exposure
  localparam int HEAD = 8, LEVELS = HEAD + LANES, WORDS = LEVELS + 512 * LANES;
  localparam bit [3:0] KTC = 15;                        // decision number of the kT/C draw

  // ---- files ----
  reg [63:0] samples[0:TAPS*FRAME-1];
  reg [63:0] words[0:WORDS-1];
  real gain, noise_scale, ktc_scale, noise_most;         // noise_most: of a decision, LSB
  real bend[0:3];                                       // LSB that the amplifier adds, times 1, x, x^2, x^3
  reg [31:0] key;
  reg noisy;
  reg [31:0] exposures;                                 // before this one: each has noise of its own
  integer file, samples_file, bytes, taps;
  reg [8*512-1:0] name;
  initial begin
    if (!$value$plusargs("samples=%s", name)) $fatal(1, "+samples=FILE is missing");
    samples_file = $fopen(name, "rb");
    if (samples_file == 0) $fatal(1, "+samples: cannot be read");
    if (!$value$plusargs("taps=%d", taps)) taps = TAPS;
    bytes = $fread(samples, samples_file, 0, taps * FRAME);
    if (bytes == 0 || bytes % (8 * FRAME) != 0) $fatal(1, "+samples: not whole taps of ROWS x COLS x 2 words");
    if (!$value$plusargs("converter=%s", name)) $fatal(1, "+converter=FILE is missing");
    file = $fopen(name, "rb");
    if (file == 0) $fatal(1, "+converter: cannot be read");
    bytes = $fread(words, file);
    if (bytes != 8 * WORDS) $fatal(1, "+converter: not for this number of lanes");
    $fclose(file);
    gain = $bitstoreal(words[0]);
    noise_scale = $bitstoreal(words[1]);
    ktc_scale = $bitstoreal(words[2]);
    noise_most = noise_scale * 510.0;
    for (int i = 0; i < 4; i++) bend[i] = $bitstoreal(words[4+i]);
    exposures = 32'd0;
    key = mix(words[3][31:0]);
    noisy = noise_scale != 0.0 || ktc_scale != 0.0;
  end

  // The next exposure, between two frames: all taps of it
  task next_exposure;
    begin
      bytes = $fread(samples, samples_file, 0, taps * FRAME);
      if (bytes != 8 * taps * FRAME) $fatal(1, "+samples: no further +taps x ROWS x COLS x 2 words");
      exposures = exposures + 32'd1;
      key = mix(words[3][31:0] + exposures);
    end
  endtask

  // ---- noise: a hash in place of a generator, models/afe/noise.py ----
  function automatic [31:0] mix(input [31:0] seed);
    reg [31:0] x;
    begin
      x = seed ^ (seed >> 16);
      x = x * 32'h7FEB352D;
      x = x ^ (x >> 15);
      x = x * 32'h846CA68B;
      mix = x ^ (x >> 16);
    end
  endfunction

  function automatic integer counts(input [27:0] index, input [3:0] number);
    reg [31:0] h;
    begin
      h = mix(key ^ {index, number});
      counts = int'(h[7:0]) + int'(h[15:8]) + int'(h[23:16]) + int'(h[31:24]) - 510;
    end
  endfunction

  reg [3:0] decision;                                   // since the hold
  initial decision = 4'd0;
  always @(posedge clk)
    if (hold) decision <= 4'd0;
    else if (decision != KTC - 4'd1) decision <= decision + 4'd1;

  // held + noise >= level. The noise is not drawn where it cannot change the decision: nearly always.
  function automatic decided(input real held, input real level, input [27:0] index, input [3:0] number);
    real noise;
    begin
      noise = 0.0;
      if (held - noise_most < level & held + noise_most >= level) noise = noise_scale * $itor(counts(index, number));
      decided = held + noise >= level;
    end
  endfunction

  // ---- lanes ----
  function automatic real level(input integer lane, input range, input [7:0] code);
    level = $bitstoreal(words[LEVELS+256*(range?LANES+lane : lane)+int'(code)]);
  endfunction

  function automatic [27:0] pixel(input integer lane, input [1:0] tap);    // of the position at the pins
    pixel = 28'((int'(tap) * ROWS + int'(row)) * COLS + (LANES * int'(group) + lane) * TILE_COLS + int'(k));
  endfunction

  function automatic real value(input integer lane);
    real a, b, x;
    integer word;
    begin
      word = 2 * int'(pixel(lane, mode == 2'd3 ? sub : 2'd0));
      a = $bitstoreal(samples[word]);
      b = $bitstoreal(samples[word+1]);
      case (mode)
        2'd0: value = gain * (a - b * (1.0 + $itor(balance) / 512.0));
        2'd2: value = 2.0 * (sub[0] ? b : a);
        default: value = a + b;
      endcase
      x = (value - (mode == 2'd0 ? 0.0 : 128.0)) / 128.0;
      value = value + (bend[0] + x * (bend[1] + x * (bend[2] + x * bend[3])));
    end
  endfunction

  for (genvar l = 0; l < LANES; l++) begin : lane
    real held;
    reg [27:0] index;
    initial begin
      held = 0.0;
      index = 28'd0;
    end
    always @(posedge clk)
      if (hold) if (en[l]) begin
        held <= value(l) + (noisy ? ktc_scale * $itor(counts(pixel(l, sub), KTC)) : 0.0) + $bitstoreal(words[HEAD+l]);
        index <= pixel(l, sub);
      end
    assign comparator[l] = decided(held, level(l, unsigned_, dac[8*l+:8]), index, decision);
  end
endmodule
`default_nettype wire
