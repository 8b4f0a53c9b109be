"""What is read from the log of Coriolis."""

from flow.layout.coriolis.log import open_nets


def test_open_nets_are_read_from_the_routers_list():
    log = """  o  Routing did not complete, unrouted segments:
      1| &<id:27198 Horizontal w916 m1 [44.37um 30.82um] [48.96um 30.82um] 0.32um rpD:3 ----- 0 ------->
      2| &<id:43820 Vertical clk_root_0 m2 [48.96um 30.82um] [48.98um 30.82um] 0.32um rpD:1 --S---->
      3| &<id:43821 Horizontal w916 m1 [48.96um 30.82um] [48.98um 30.82um] 0.32um rpD:1 --S---->
[WARNING] Track::repair(): Closing same net gap in <HorizontalTrack [285] m1 @131.1um> near:
          <id:660094 Vertical w10315 m2 [60.69um 333.2um] [60.69um 333.5um] 0.37um rpD:1>
"""
    assert open_nets(log) == ["w916", "clk_root_0"]
