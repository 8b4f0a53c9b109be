// Clocks Lanes (lanes.sv) until it is done.
#include "VLanes.h"
#include "verilated.h"

int main(int argc, char** argv) {
  VerilatedContext context;
  context.commandArgs(argc, argv);
  VLanes top{&context};
  while (!top.done && !context.gotFinish()) {
    top.clk = !top.clk;
    top.eval();
  }
  top.final();
  return !top.done;
}
