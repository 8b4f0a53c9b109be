"""Steps from files to files: Verilog -> simulator -> stream -> pictures -> report. Knows no object of rtl."""
