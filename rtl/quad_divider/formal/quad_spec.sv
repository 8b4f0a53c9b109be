// The specified response, written from the README, not from the RTL: octants by comparison, the phase by the
// golden model's table `phase_of_ratio` (verif/formal/tables.py). The wrapper specifies the ratio.

module QuadSpec (
  input [8:0] x, input [8:0] y, input [7:0] noise_floor, input [28:0] msg,
  output [2:0] octant_spec, output [8:0] larger, output [8:0] smaller,
  output [7:0] ratio, output octant_ok, output flags_ok, output phase_ok
);
  wire [2:0] octant; wire zero; wire [7:0] phase; wire amp_valid; wire [7:0] amp;
  assign {octant, ratio, zero, phase, amp_valid, amp} = msg;

  wire signed [9:0] sx = {x[8], x}, sy = {y[8], y};
  wire [9:0] ax = sx < 0 ? -sx : sx, ay = sy < 0 ? -sy : sy;
  wire origin = x == 0 && y == 0;
  assign larger = ax > ay ? ax : ay;
  assign smaller = ax > ay ? ay : ax;

  reg [2:0] sector;
  always @* begin
    if (origin) sector = 0;
    else if (sx > 0 && sy >= 0) sector = ay < ax ? 0 : 1;
    else if (sx <= 0 && sy > 0) sector = ax < ay ? 2 : 3;
    else if (sx < 0 && sy <= 0) sector = ay < ax ? 4 : 5;
    else sector = ax < ay ? 6 : 7;
  end
  assign octant_spec = sector;
  assign octant_ok = octant == sector;

  assign flags_ok = zero == origin && amp == (larger > 255 ? 8'd255 : larger[7:0])
                    && amp_valid == (!origin && larger >= {1'b0, noise_floor});

  wire [7:0] index = phase_of_ratio(ratio);
  wire [7:0] axis = sector == 1 || sector == 2 ? 64 : sector == 3 || sector == 4 ? 128
                    : sector == 5 || sector == 6 ? 192 : 0;
  assign phase_ok = phase == (origin ? 8'd0 : sector[0] ? axis - index : axis + index);
endmodule
