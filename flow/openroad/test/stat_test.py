"""What stat says, in the form of Yosys 0.23 (Debian's) and of 0.70."""

from talbot.flow.openroad.stat import counted

OLD = """=== top ===

   Number of wires:                575
   Number of cells:                597
     sky130_fd_sc_hd__and2_0         3

   Chip area for module '\\\\top': 3979.212800
"""
NEW = """=== top ===

        +----------Local Count, excluding submodules.
        |        +-Local Area, excluding submodules.
        |        |
      532        - wires
      554 3.83E+03 cells
        9   56.304   sky130_fd_sc_hd__and2_0

   Chip area for module '\\\\top': 3829.923200
     of which used for sequential elements: 720.691200 (18.82%)
"""


def test_both_forms():
    assert counted(OLD) == (597, 3979.2128)
    assert counted(NEW) == (554, 3829.9232)
    assert counted("") == (None, None)
