# Sorts `length` words at word `address` by the accelerator; a0: their number
li t0, 0x8000
li t1, length
slli t1, t1, 16
addi t1, t1, address
sw t1, 0(t0)
lw a0, 0(t0)
ebreak
