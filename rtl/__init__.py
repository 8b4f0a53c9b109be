"""The digital chip in PyMTL3: one folder a block, each at FL, CL where cycles matter, and RTL."""

from talbot.rtl import pymtl_compat  # before PyMTL3 is imported
