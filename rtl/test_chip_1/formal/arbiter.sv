// Arbiter: a grant to one that asks, and a request that stays is refused four times at most, whatever the others do.

module ArbiterProof (input clk, input reset, input data_asks, input fetch_asks, input sort_asks, input host_asks);
  wire data_grant, fetch_grant, sort_grant, host_grant;
  Arbiter dut (.*);
  (* hierconn *) wire [3:0] \dut.refused ;

  wire [3:0] asks = {host_asks, sort_asks, fetch_asks, data_asks};
  wire [3:0] grants = {host_grant, sort_grant, fetch_grant, data_grant};
  reg first = 1, was_reset;
  reg [3:0] waits;                     // refused in the cycle before
  reg [2:0] data_age, fetch_age, sort_age, host_age;  // refusals in a row
  always @(posedge clk) begin
    first <= 0; was_reset <= reset; waits <= reset ? 0 : asks & ~grants;
    data_age <= !reset && data_asks && !data_grant ? data_age + (data_age != 7) : 0;
    fetch_age <= !reset && fetch_asks && !fetch_grant ? fetch_age + (fetch_age != 7) : 0;
    sort_age <= !reset && sort_asks && !sort_grant ? sort_age + (sort_age != 7) : 0;
    host_age <= !reset && host_asks && !host_grant ? host_age + (host_age != 7) : 0;
  end

  always @* begin
    if (first) a_reset: assume (reset);
    else begin
      p_one: assert (!(grants & (grants - 1)));
      p_asked: assert (!(grants & ~asks));
      p_works: assert (!asks || waits & ~asks || grants);   // no cycle is lost but to a request that was withdrawn
      p_fair: assert (data_age <= 4 && fetch_age <= 4 && sort_age <= 4 && host_age <= 4);
      inv_waits: assert (\dut.refused == waits);
      inv_ages: assert ({host_age != 0, sort_age != 0, fetch_age != 0, data_age != 0} == waits);
    end
  end

  always @* if (!first && !was_reset) begin
    c_late: cover (host_grant && host_age == 3);
    c_new: cover (host_grant && host_age == 0);
    c_withdrawn: cover (waits && !asks);
  end
endmodule
