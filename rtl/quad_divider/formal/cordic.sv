// CORDIC: every request gets one response, its own, equal to that of the golden model (models/digital/cordic.py),
// which runs here in parallel in the README's formats with the model's table of angles. `request` and `floor` are any
// request, fixed.

module CordicProof (
  input clk, input reset, input [17:0] recv__msg, input recv__val, input send__rdy, input [7:0] noise_floor
);
  wire recv__rdy, send__val;
  wire [28:0] send__msg;
  Cordic dut (.*);
  localparam F = 10;      // iterations, and fraction bits

  (* hierconn *) wire [3:0] \dut.dpath.i ;
  (* hierconn *) wire [8 + F:0] \dut.dpath.x ;
  (* hierconn *) wire [9 + F:0] \dut.dpath.y ;
  (* hierconn *) wire [6 + F:0] \dut.dpath.z ;
  (* hierconn *) wire [2:0] \dut.dpath.octant ;
  (* hierconn *) wire [8:0] \dut.dpath.larger ;
  (* hierconn *) wire \dut.dpath.amp_valid ;
  (* hierconn *) wire \dut.ctrl.running ;
  (* hierconn *) wire \dut.ctrl.done ;

  (* anyconst *) wire [17:0] request;
  (* anyconst *) wire [7:0] floor;
  wire octant_ok, flags_ok, phase_of_table;
  wire [2:0] octant;
  wire [8:0] larger, smaller;
  wire [7:0] ratio;
  QuadSpec spec (.x(request[17:9]), .y(request[8:0]), .noise_floor(floor), .msg(send__msg), .octant_ok(octant_ok),
                 .flags_ok(flags_ok), .phase_ok(phase_of_table), .octant_spec(octant), .larger(larger),
                 .smaller(smaller), .ratio(ratio));

  reg pending = 0, mine;
  reg [4:0] age;
  reg [8 + F:0] x;
  reg signed [9 + F:0] y;
  reg signed [6 + F:0] z;
  wire [3:0] i = age;             // the next rotation is by atan(2^-i)
  wire signed [9 + F:0] y_shifted = y >>> i;
  wire [8 + F:0] x_shifted = x >> i;
  wire [6 + F:0] angle = cordic_angle(i - 1);
  reg first = 1, was_reset, was_val, was_rdy;
  reg [28:0] was_msg;
  wire taken = recv__val && recv__rdy, left = send__val && send__rdy;
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; was_val <= send__val; was_rdy <= send__rdy; was_msg <= send__msg;
    if (reset) pending <= 0;
    else if (taken) begin
      pending <= 1; mine <= recv__msg == request && noise_floor == floor; age <= 1;
      x <= larger << F; y <= smaller << F; z <= 0;
    end else if (left) pending <= 0;
    else begin
      age <= age + !(&age);
      if (age <= F) begin
        x <= y >= 0 ? x + y_shifted[8 + F:0] : x - y_shifted[8 + F:0];
        y <= y >= 0 ? y - {1'b0, x_shifted} : y + {1'b0, x_shifted};
        z <= y >= 0 ? z + angle : z - angle;
      end
    end
  end

  // z rounded to the nearest integer, ties to even
  wire [7:0] whole = {z[6 + F], z[6 + F:F]};
  wire [F - 1:0] fraction = z[F - 1:0];
  wire [7:0] index = whole + (fraction > 1 << F - 1 || fraction == 1 << F - 1 && whole[0]);
  wire [7:0] axis = 32 * (octant + octant[0]);
  wire [7:0] phase = request == 0 ? 8'd0 : octant[0] ? axis - index : axis + index;

  always @* begin
    if (first) a_reset: assume (reset);
    if (!first) begin
      p_octant: assert (!(send__val && mine) || octant_ok);
      p_ratio: assert (!send__val || ratio == 0);
      p_flags: assert (!(send__val && mine) || flags_ok);
      p_phase: assert (!(send__val && mine) || send__msg[16:9] == phase);
      p_one: assert (!send__val || pending);
      p_room: assert (recv__rdy == !pending);
      p_latency: assert (!pending || send__val == (age >= F + 1));
      p_stable: assert (was_reset || !was_val || was_rdy || send__val && send__msg == was_msg);
      inv_count: assert (!\dut.ctrl.running || \dut.dpath.i < F && age == \dut.dpath.i + 1);
      inv_vector: assert (!(pending && mine) || \dut.dpath.x == x && \dut.dpath.y == y && \dut.dpath.z == z);
      inv_octant: assert (!(pending && mine) || \dut.dpath.octant == octant && \dut.dpath.larger == larger
                          && \dut.dpath.amp_valid == (larger != 0 && larger >= {1'b0, floor}));
      inv_state: assert (pending == (\dut.ctrl.running || \dut.ctrl.done ) && !(\dut.ctrl.running && \dut.ctrl.done ));
    end
  end

  always @* if (!first && !was_reset) begin
    c_answer: cover (send__val && mine && request == {9'd3, 9'h1FE});
    c_waits: cover (send__val && was_val && !was_rdy);
  end
endmodule
